// SPDX-License-Identifier: Apache-2.0
// The IMU inside a LiDAR: its packets among those of points, on the clock of the sweeps.
#include <cstring>

#include <gtest/gtest.h>

#include "drivers/lidar/livox_sweeps.hpp"
#include "drivers/lidar/ouster_sweeps.hpp"
#include "drivers/replay/rig_clock.hpp"
#include "tests/support/livox_packets.hpp"
#include "tests/support/replay_ouster.hpp"

namespace lxd::drivers_lidar_inertial_test {
namespace {

using replay_test::made_metadata;
using replay_test::made_packet;
using replay_test::Packet;

constexpr std::uint64_t kGyro_ns = 5'000'000;

// 1 g along z, 90 degrees a second about x.
Packet legacy_imu() {
  Packet bytes(kOusterLegacyImu.record.bytes);
  kOusterLegacyImu.record.accel_ns.set(bytes.data(), kGyro_ns + 1'000);
  kOusterLegacyImu.record.gyro_ns.set(bytes.data(), kGyro_ns);
  const float one_g = 1, quarter_turn = 90;
  std::memcpy(bytes.data() + kOusterLegacyImu.record.accel_at + 2 * sizeof(float), &one_g, sizeof(float));
  std::memcpy(bytes.data() + kOusterLegacyImu.record.gyro_at, &quarter_turn, sizeof(float));
  return bytes;
}

class OusterInertial : public testing::Test {
 protected:
  OusterInertial() : storage_(1000), sweeps_(metadata_, std::make_unique<RigClock>(ClockModelConfig{})) {
    sweep_.storage = storage_;
  }

  // A packet of points, received 1 ms after its last column.
  void points(std::uint16_t column, std::uint64_t time_ns) {
    const Packet bytes = made_packet(metadata_, 1, column, time_ns, 5000);
    EXPECT_TRUE(sweeps_.inertial(bytes, received_).empty());
    ASSERT_TRUE(sweeps_.parse(bytes));
    sweep_.count = 0;
    (void)sweeps_.take(received_ = RigTime::from_ns(static_cast<std::int64_t>(time_ns)) + kRigAhead + kWay, sweep_);
  }

  static constexpr Duration kRigAhead = Duration::from_ns(7'000'000'000), kWay = Duration::from_ns(1'000'000);
  OusterMetadata metadata_ = made_metadata("RNG19_RFL8_SIG16_NIR16");
  std::vector<LidarPoint> storage_;
  Sweep sweep_;
  RigTime received_;
  OusterSweeps sweeps_;
};

TEST_F(OusterInertial, BeforeAnyPointsTheClockIsNotKnown) {
  EXPECT_TRUE(sweeps_.inertial(legacy_imu(), RigTime::from_ns(1)).empty());
}

// Given points whose clock is known; then a sample of the IMU has its values in SI units and its gyroscope's time on
// the clock of the sweeps.
TEST_F(OusterInertial, SamplesAreOnTheSweepsClock) {
  for (std::uint16_t column = 0; column < 64; column += 16) points(column, 4'000'000U + 100'000U * column);
  const auto samples = sweeps_.inertial(legacy_imu(), received_);
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_EQ(samples[0].sensor_ns, std::int64_t{kGyro_ns});
  EXPECT_NEAR((samples[0].t - RigTime::from_ns(kGyro_ns)).seconds(), (kRigAhead + kWay).seconds(), 2e-3);
  EXPECT_NEAR(samples[0].accel_mps2.z(), 9.80665, 1e-6);
  EXPECT_NEAR(samples[0].gyro_radps.x(), 1.5707963, 1e-6);
}

TEST_F(OusterInertial, DamagedOnesAreCounted) {
  points(0, 4'000'000U);
  Packet bytes = legacy_imu();
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(bytes.data() + kOusterLegacyImu.record.gyro_at, &nan, sizeof(float));
  EXPECT_TRUE(sweeps_.inertial(bytes, received_).empty());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    EXPECT_TRUE(sweeps_.inertial(std::span(bytes).first(size), received_).empty()) << size;
  Rejections rejected;
  sweeps_.report_inertial(rejected);
  EXPECT_EQ(rejected["not_finite"], 1U);
}

TEST(LivoxInertial, SamplesAreOnTheSweepsClock) {
  LivoxSweeps sweeps({LivoxPacketParser(kMid360Lines)}, std::make_unique<RigClock>(ClockModelConfig{}));
  const auto imu = test::from_hex(test::kLivoxImu), points = test::from_hex(test::kLivoxCartesian);
  const RigTime received = RigTime::from_seconds(50);
  EXPECT_TRUE(sweeps.inertial(imu, received).empty());  // nothing of the clock is known
  EXPECT_TRUE(sweeps.inertial(points, received).empty());
  ASSERT_TRUE(sweeps.parse(points));
  Sweep sweep;
  (void)sweeps.take(received, sweep);
  const auto samples = sweeps.inertial(imu, received);
  ASSERT_EQ(samples.size(), 1U);
  EXPECT_NEAR((samples[0].t - received).seconds(), 0, 0.002);
  EXPECT_EQ(samples[0].gyro_radps, Eigen::Vector3d(0.125, -0.25, 0.5));
  EXPECT_NEAR(samples[0].accel_mps2.z(), 9.80665, 1e-4);
}

}  // namespace
}  // namespace lxd::drivers_lidar_inertial_test
