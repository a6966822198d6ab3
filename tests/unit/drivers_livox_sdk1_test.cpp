// SPDX-License-Identifier: Apache-2.0
// Livox SDK1 datagrams: every kind of record by hand, damage, and a capture of an Avia from packets to sweeps.
#include <gtest/gtest.h>

#include "drivers/livox/sdk1_parser.hpp"
#include "drivers/livox/sweep_builder.hpp"
#include "rt/allocation_guard.hpp"
#include "tests/support/livox_packets.hpp"
#include "tests/support/replay_ouster.hpp"

namespace lxd::drivers_livox_sdk1_test {
namespace {

using Bytes = std::vector<std::uint8_t>;
using test::from_hex;

// Version 5, slot 0, sensor 1, no error, PTP, then the type; stamp 1 s.
Bytes packet_of(std::uint8_t data_type, const std::string& records, std::uint64_t stamp = 1'000'000'000,
                std::uint8_t time_type = 1) {
  Bytes bytes = from_hex("050001000000000000000000000000000000");
  bytes[8] = time_type;
  bytes[9] = data_type;
  bytes_at(0, 8).set(&bytes[kLivoxSdk1TimeAt], stamp);
  const Bytes data = from_hex(records);
  bytes.insert(bytes.end(), data.begin(), data.end());
  return bytes;
}

// x 1.5 m, y -2.5 m, z 0.3 m; then reflectivity 75. A depth of 2 m; zenith 90 deg, azimuth 270 deg.
const std::string kXyz = "dc0500003cf6ffff2c010000", kDepth = "d0070000", kAngles = "28237869";
const std::string kFar = "b80b00000000000000000000", kFarDepth = "b80b0000";  // 3 m

struct Kind {
  std::uint8_t type;
  std::string record;
  std::uint32_t echoes;
  bool cartesian;
};
const std::vector<Kind> kKinds{{0, kXyz + "4b", 1, true},
                               {1, kDepth + kAngles + "4b", 1, false},
                               {2, kXyz + "4b00", 1, true},
                               {3, kDepth + kAngles + "4b00", 1, false},
                               {4, kXyz + "4b10" + kFar + "0a20", 2, true},
                               {5, kAngles + kDepth + "4b10" + kFarDepth + "0a20", 2, false},
                               {7, kXyz + "4b10" + kFar + "0a20" + kFar + "0a30", 3, true},
                               {8, kAngles + kDepth + "4b10" + kFarDepth + "0a20" + kFarDepth + "0a30", 3, false}};

TEST(LivoxSdk1, EveryKindOfRecordIsRead) {
  for (const Kind& kind : kKinds) {
    LivoxSdk1Parser parser(kLivoxMidShot_ns);
    LivoxPacket packet;
    const Bytes bytes = packet_of(kind.type, kind.record + kind.record);
    ASSERT_TRUE(parser.parse(bytes, packet)) << int{kind.type};
    EXPECT_EQ(packet.count, 2U);
    EXPECT_EQ(packet.echoes(), kind.echoes);
    EXPECT_EQ(packet.timestamp_ns, 1'000'000'000U);
    EXPECT_EQ(packet.duration_ns, 2 * kLivoxMidShot_ns);
    const Eigen::Vector3f first = kind.cartesian ? Eigen::Vector3f(1.5F, -2.5F, 0.3F) : Eigen::Vector3f(0, -2, 0);
    EXPECT_TRUE(packet.point(1).p_m.isApprox(first, 1e-5F)) << int{kind.type};
    EXPECT_EQ(packet.point(1).reflectivity, 75);
    EXPECT_EQ(packet.point(1).offset_ns, kLivoxMidShot_ns);
    for (std::uint32_t echo = 1; echo < kind.echoes; ++echo) {
      EXPECT_NEAR(packet.point(1, echo).p_m.norm(), 3, 1e-5) << int{kind.type};
      EXPECT_EQ(packet.point(1, echo).reflectivity, 10);
      EXPECT_FALSE(packet.point(1, echo).noise) << "the echo's number is no doubt about it";
    }
  }
}

TEST(LivoxSdk1, InertialDataAreThoseOfSdk2) {
  LivoxSdk1Parser parser(kLivoxHorizonShot_ns);
  LivoxPacket packet;
  const Bytes bytes = packet_of(6, "0000003e000080be0000003f00000000000000bf0000803f");
  ASSERT_TRUE(parser.parse(bytes, packet));
  ASSERT_TRUE(packet.is_imu());
  EXPECT_TRUE(packet.imu().gyro_radps.isApprox(Eigen::Vector3d(0.125, -0.25, 0.5)));
  EXPECT_TRUE(packet.imu().accel_mps2.isApprox(Eigen::Vector3d(0, -4.903325, 9.80665)));
}

TEST(LivoxSdk1, TagsSayWhatIsNoise) {
  for (const auto& [tag, noise] : {std::pair{0x00, false},
                                   {0x01, true},
                                   {0x02, true},
                                   {0x03, false},
                                   {0x04, true},
                                   {0x08, true},
                                   {0x0C, false},
                                   {0x30, false}}) {
    EXPECT_EQ(livox_tag_is_noise(static_cast<std::uint8_t>(tag), LivoxTags::kSdk1), noise) << tag;
  }
}

// 2021-02-03, hour 4 and 5.000006 s; then parts that no clock has.
TEST(LivoxSdk1, GpsTimeComesInParts) {
  const Bytes stamp = from_hex("15020304464b4c00");
  EXPECT_EQ(livox_sdk1_time_ns(kLivoxSdk1Gps, stamp.data()), 1'612'324'800'000'000'000U + 5'000'006'000U);
  for (const char* const wrong :
       {"150d0304404b4c00", "15021e04404b4c00", "15020318404b4c00", "1502030400a493d6", "15000304404b4c00"}) {
    EXPECT_FALSE(livox_sdk1_time_ns(kLivoxSdk1Gps, from_hex(wrong).data())) << wrong;
  }
  LivoxSdk1Parser parser(kLivoxMidShot_ns);
  LivoxPacket packet;
  const Bytes bytes = packet_of(0, kXyz + "4b", bytes_at(0, 8).get(stamp.data()), 3);
  ASSERT_TRUE(parser.parse(bytes, packet));
  EXPECT_EQ(packet.clock, LivoxClock::kGps);
  EXPECT_FALSE(parser.parse(packet_of(0, kXyz + "4b", ~0ULL, 3), packet));
  EXPECT_EQ(parser.counts().bad_time, 1U);
}

TEST(LivoxSdk1, AnyOtherLengthIsRefused) {
  for (const Kind& kind : kKinds) {
    const Bytes whole = packet_of(kind.type, kind.record);
    LivoxSdk1Parser parser(kLivoxMidShot_ns);
    LivoxPacket packet;
    for (std::size_t bytes = 0; bytes < whole.size(); ++bytes) {
      const Bytes cut(whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(bytes));  // its own heap block
      EXPECT_FALSE(parser.parse(cut, packet)) << int{kind.type} << " " << bytes;
    }
    EXPECT_EQ(parser.counts().bad_size, kLivoxSdk1HeaderBytes);
    EXPECT_EQ(parser.counts().bad_count, whole.size() - kLivoxSdk1HeaderBytes);  // among them a packet of 0 points
    Bytes longer = whole;
    longer.push_back(0);
    EXPECT_FALSE(parser.parse(longer, packet));
  }
}

// There is no check value: whatever a flipped bit makes of a packet stays within its bytes and gives finite points.
TEST(LivoxSdk1, AnySingleBitFlipIsRefusedOrHarmless) {
  for (const Kind& kind : kKinds) {
    Bytes bytes = packet_of(kind.type, kind.record + kind.record + kind.record);
    for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
      bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
      LivoxSdk1Parser parser(kLivoxMidShot_ns);
      LivoxPacket packet;
      if (parser.parse(bytes, packet) && !packet.is_imu()) {
        EXPECT_LE(packet.data + packet.count * packet.record->bytes, bytes.data() + bytes.size());
        for (std::uint32_t i = 0; i < packet.count; ++i)
          EXPECT_TRUE(packet.point(i, packet.echoes() - 1).p_m.allFinite());
      }
      bytes[bit / 8] ^= static_cast<std::uint8_t>(1U << bit % 8);
    }
  }
}

TEST(LivoxSdk1, EveryCauseIsCountedAsItself) {
  LivoxSdk1Parser parser(kLivoxMidShot_ns);
  LivoxPacket packet;
  EXPECT_FALSE(parser.parse(packet_of(9, kXyz + "4b"), packet));
  EXPECT_EQ(parser.counts().bad_type, 1U);
  EXPECT_FALSE(parser.parse(packet_of(0, kXyz + "4b", 0, 2), packet));
  EXPECT_EQ(parser.counts().bad_time_type, 1U);
  EXPECT_FALSE(parser.parse(packet_of(0, kXyz + "4b", 1ULL << 62U), packet));
  EXPECT_EQ(parser.counts().bad_time, 1U);
  EXPECT_FALSE(parser.parse(packet_of(6, "0000c07f000080be0000003f00000000000000bf0000803f"), packet));
  EXPECT_EQ(parser.counts().bad_imu_values, 1U);
  std::string many;
  for (std::size_t i = 0; i <= kLivoxSdk1ShotsMax; ++i) many += kXyz + "4b";
  EXPECT_FALSE(parser.parse(packet_of(0, many), packet));
  EXPECT_EQ(parser.counts().bad_count, 1U);
}

// A captured sensor: packets of 96 shots, 2500 a second, in the same sweeps as those of SDK2.
class LivoxSdk1Capture : public testing::Test {
 protected:
  std::unique_ptr<SweepSource> opened(std::uint32_t shot_ns, std::uint8_t type, std::size_t packets) {
    std::vector<replay_test::SentPacket> sent;
    for (std::size_t i = 0; i < packets; ++i) {
      std::string records;
      for (int k = 0; k < 96; ++k) records += record(type);
      const std::uint64_t stamp = 5'000'000'000 + i * 96 * std::uint64_t{shot_ns};
      sent.push_back({packet_of(type, records, stamp), 1, 56000});
      if (i % 50 == 20) sent.push_back({packet_of(type, records, stamp), 2, 56000});  // another sensor
    }
    replay_test::write_bytes(folder_.path() / "avia.pcap", replay_test::made_pcap(sent, 1480));
    auto source = open_recording(folder_.path() / "avia.pcap", {});
    EXPECT_TRUE(source.ok()) << source.error().message;
    return source.ok() ? std::move(*source) : nullptr;
  }
  static const std::string& record(std::uint8_t type) {
    for (const Kind& kind : kKinds)
      if (kind.type == type) return kind.record;
    return kKinds.front().record;
  }
  test::TemporaryFolder folder_;
};

TEST_F(LivoxSdk1Capture, BecomesSweepsOfATenthOfASecond) {
  for (const std::uint32_t shot_ns : {kLivoxHorizonShot_ns, kLivoxMidShot_ns}) {
    const std::size_t packets = 300'000'000 / (96 * shot_ns);
    const auto source = opened(shot_ns, 2, packets);
    ASSERT_NE(source, nullptr);
    EXPECT_EQ(source->kind(), "livox-pcap");
    const auto sweeps = replay_test::read_all(*source);
    ASSERT_GE(sweeps.size(), 3U);
    EXPECT_NEAR((sweeps[0].header.end - sweeps[0].header.begin).seconds(), 0.1, 0.002) << shot_ns;
    EXPECT_NEAR(static_cast<double>(sweeps[0].points.size()), 0.1e9 / shot_ns, 200);
    EXPECT_EQ(source->rejected().at("other_sensor"), (packets - 21) / 50 + 1);
    EXPECT_FALSE(source->rejected().contains("missing_packet"));
  }
}

TEST_F(LivoxSdk1Capture, EchoesOfAShotAreAllPoints) {
  const auto source = opened(kLivoxHorizonShot_ns, 4, 300);
  ASSERT_NE(source, nullptr);
  const auto sweeps = replay_test::read_all(*source);
  ASSERT_FALSE(sweeps.empty());
  EXPECT_NEAR(static_cast<double>(sweeps[0].points.size()), 2 * 0.1e9 / kLivoxHorizonShot_ns, 400);
  EXPECT_EQ(sweeps[0].points[0].offset_ns, sweeps[0].points[1].offset_ns);
}

TEST(LivoxSdk1RealTime, PacketsAllocateNothing) {
  const Bytes bytes = packet_of(4, kKinds[4].record + kKinds[4].record);
  std::vector<LidarPoint> storage(16);
  Sweep sweep;
  sweep.storage = storage;
  const AllocationGuard guard;
  LivoxSdk1Parser parser(kLivoxHorizonShot_ns);
  LivoxSweepBuilder builder(Duration::from_ns(100'000'000));
  LivoxPacket packet;
  EXPECT_TRUE(parser.parse(bytes, packet));
  builder.add(packet, sweep);
  EXPECT_EQ(sweep.count, 4U);
  EXPECT_EQ(guard.count(), 0U);
}

}  // namespace
}  // namespace lxd::drivers_livox_sdk1_test
