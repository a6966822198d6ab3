// SPDX-License-Identifier: Apache-2.0
// An Ouster's inertial packets of both profiles: real captures, damage, and what the simulator writes.
#include <gtest/gtest.h>

#include "drivers/ouster/imu_parser.hpp"
#include "tests/support/captured_datagrams.hpp"
#include "tests/support/replay_files.hpp"
#include "tools/simulator/lidar/ouster_imu_encoder.hpp"

namespace lxd::test::drivers_ouster_imu_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

std::vector<Bytes> imu_datagrams(const std::filesystem::path& pcap, std::size_t bytes) {
  std::vector<Bytes> found;
  for (const CapturedDatagram& datagram : read_capture(pcap).datagrams) {
    if (datagram.bytes.size() == bytes) found.push_back(datagram.bytes);
  }
  return found;
}

Bytes made(const OusterImuProfile& profile, std::size_t records) {
  std::vector<OusterImuSample> samples;
  for (std::size_t i = 0; i < records; ++i) {
    samples.push_back({1000 + i, 1000 + i, Eigen::Vector3d(0.1, -0.2, 9.8), Eigen::Vector3d(0.01, 0.02, -0.03)});
  }
  return sim::encode_ouster_imu(profile, {.frame_id = 5, .init_id = 77, .serial = 99, .system_ns = 900}, samples);
}

TEST(OusterImuGolden, LegacyPacketOfARealSensor) {
  // The values were read with Python's struct from the capture's first inertial packet.
  const auto packets = imu_datagrams(replay_test::clone_ouster() / "OS-0-32-U1_v2.2.0_1024x10.pcap", 48);
  ASSERT_EQ(packets.size(), 10U);
  OusterImuParser parser(kOusterLegacyImu, std::nullopt);
  OusterImuPacket packet;
  ASSERT_TRUE(parser.parse(packets[0], packet));
  ASSERT_EQ(packet.samples().size(), 1U);
  const OusterImuSample& sample = packet.samples()[0];
  EXPECT_EQ(sample.accel_ns, 515838794380U);
  EXPECT_EQ(sample.gyro_ns, 515839016690U);
  EXPECT_LT((sample.accel_mps2 - 9.80665 * Eigen::Vector3d(-0.00146484375, -0.056884765625, 1.014404296875)).norm(),
            1e-9);
  constexpr double kRadPerDeg = 3.14159265358979323846 / 180;
  const Eigen::Vector3d gyro_degps(0.45013427734375, 0.66375732421875, 0.14495849609375);
  EXPECT_LT((sample.gyro_radps - kRadPerDeg * gyro_degps).norm(), 1e-12);
}

TEST(OusterImuGolden, PacketsOfARealSensorWithHeader) {
  const auto path = replay_test::shared_ouster("imu_zm_no_lidar.pcap");
  if (!path) GTEST_SKIP() << "imu_zm_no_lidar.pcap: LXD_SHARED_DATA is not set";
  const auto packets = imu_datagrams(*path, 452);
  ASSERT_EQ(packets.size(), 8U);
  OusterImuParser parser(kOusterAccelGyroNmea, 15079160);  // the metadata's
  OusterImuPacket packet;
  std::uint64_t before_ns = 0;
  for (const Bytes& bytes : packets) {
    ASSERT_TRUE(parser.parse(bytes, packet));
    ASSERT_EQ(packet.samples().size(), 8U);
    for (const OusterImuSample& sample : packet.samples()) {
      EXPECT_NEAR(sample.accel_mps2.norm(), 9.8, 0.3);
      EXPECT_LT(sample.gyro_radps.norm(), 0.2);
      EXPECT_GT(sample.gyro_ns, before_ns);
      before_ns = sample.gyro_ns;
    }
  }
  ASSERT_TRUE(parser.parse(packets[0], packet));
  EXPECT_EQ(packet.samples()[0].gyro_ns, 16177228652952U);
  EXPECT_FLOAT_EQ(static_cast<float>(packet.samples()[0].accel_mps2.z()), 9.782708168029785F);
}

class OusterImuProfiles : public testing::TestWithParam<std::pair<const OusterImuProfile*, std::size_t>> {
 protected:
  const OusterImuProfile& profile_ = *GetParam().first;
  Bytes whole_ = made(profile_, GetParam().second);
  OusterImuPacket packet_;
};

TEST_P(OusterImuProfiles, ReadsBackWhatTheSimulatorWrites) {
  OusterImuParser parser(profile_, 77);
  ASSERT_TRUE(parser.parse(whole_, packet_));
  ASSERT_EQ(packet_.samples().size(), GetParam().second);
  const OusterImuSample& last = packet_.samples().back();
  EXPECT_EQ(last.gyro_ns, 1000 + GetParam().second - 1);
  EXPECT_LT((last.accel_mps2 - Eigen::Vector3d(0.1, -0.2, 9.8)).norm(), 1e-6);
  EXPECT_LT((last.gyro_radps - Eigen::Vector3d(0.01, 0.02, -0.03)).norm(), 1e-8);
}

TEST_P(OusterImuProfiles, AnyOtherLengthIsRefused) {
  OusterImuParser parser(profile_, 77);
  for (std::size_t bytes = 0; bytes < whole_.size(); ++bytes) {
    const Bytes cut(whole_.begin(),
                    whole_.begin() + static_cast<std::ptrdiff_t>(bytes));  // its own heap block, for ASan
    EXPECT_FALSE(parser.parse(cut, packet_));
  }
  whole_.push_back(0);
  EXPECT_FALSE(parser.parse(whole_, packet_));
  EXPECT_EQ(parser.counts().packets, 0U);
}

TEST_P(OusterImuProfiles, AnySingleBitFlipIsCountedOnce) {
  for (std::size_t bit = 0; bit < whole_.size() * 8; ++bit) {
    whole_[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    OusterImuParser parser(profile_, 77);
    const bool accepted = parser.parse(whole_, packet_);
    EXPECT_EQ(accepted, !profile_.crc.present()) << "bit " << bit;
    const OusterImuCounts& c = parser.counts();
    EXPECT_EQ(c.packets + c.bad_packet_type + c.bad_crc, 1U);
    if (accepted) {
      for (const OusterImuSample& sample : packet_.samples()) EXPECT_TRUE(sample.accel_mps2.allFinite());
    }
    whole_[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
  }
}

INSTANTIATE_TEST_SUITE_P(Both, OusterImuProfiles,
                         testing::Values(std::pair(&kOusterLegacyImu, std::size_t{1}),
                                         std::pair(&kOusterAccelGyroNmea, std::size_t{8})));

TEST(OusterImu, EveryCauseIsCountedAsItself) {
  OusterImuPacket packet;
  OusterImuParser other(kOusterAccelGyroNmea, 78);
  EXPECT_FALSE(other.parse(made(kOusterAccelGyroNmea, 8), packet));
  EXPECT_EQ(other.counts().bad_init_id, 1U);
  OusterImuParser parser(kOusterLegacyImu, std::nullopt);
  Bytes bytes = made(kOusterLegacyImu, 1);
  bytes_at(24, 4).set(bytes.data(), 0x7F800000);  // infinite
  EXPECT_TRUE(parser.parse(bytes, packet));
  EXPECT_TRUE(packet.samples().empty());
  EXPECT_EQ(parser.counts().non_finite_record, 1U);
}

}  // namespace
}  // namespace lxd::test::drivers_ouster_imu_test
