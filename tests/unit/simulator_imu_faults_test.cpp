// SPDX-License-Identifier: Apache-2.0
// Faults of the simulated IMU, seen in its bytes: what was asked for, when it was asked for, and counted; and what a
// user can get wrong.
#include <gtest/gtest.h>

#include "drivers/imu/witmotion_format.hpp"
#include "tests/support/simulated_imu.hpp"
#include "tools/simulator/imu/imu_model.hpp"

namespace lxd::sim::simulator_imu_faults_test {
namespace {

using test::SimulatedImu;

constexpr double kPeriod_s = 0.005;

// Samples of 2 s with a fault from 0.5 to 1 s: those at 100 <= k < 200.
constexpr std::size_t kBegin = 100, kEnd = 200, kAll = 401;
bool during(std::size_t k) { return k >= kBegin && k < kEnd; }
SimulatedImu with_fault(const char* name, double value) {
  // Off the samples' instants, so that rounding decides nothing.
  return SimulatedImu(2, {{name, 0.5 - kPeriod_s / 2, 1 - kPeriod_s / 2, value}});
}
Inertial truth_at(const SimulatedImu& rig, std::size_t k) {
  return true_inertial(rig.motion, {}, static_cast<double>(k) * kPeriod_s);
}

TEST(SimulatorImuFaults, AllHaveNamesThatSayTheirSensor) {
  EXPECT_EQ(imu_faults().size(), 7U);
  for (const KnownFault& fault : imu_faults()) {
    EXPECT_TRUE(fault.name.starts_with("imu_"));
    EXPECT_FALSE(fault.what.empty());
    EXPECT_EQ(fault.value != 0, !fault.unit.empty()) << fault.name;
  }
}

TEST(SimulatorImuFaults, AGapSendsNothing) {
  SimulatedImu rig = with_fault("imu_gap", 0);
  const ImuWritten written = rig.write();
  const auto samples = rig.read();
  ASSERT_EQ(samples.size(), kAll - 100);
  EXPECT_EQ(written.faults.gap, 100U);
  EXPECT_EQ(*samples[kBegin].sensor_ns - *samples[kBegin - 1].sensor_ns, 505'000'000);
}

TEST(SimulatorImuFaults, ClippingHoldsTheAccelerometerAtItsValue) {
  SimulatedImu rig = with_fault("imu_clip", 0.5);
  const ImuWritten written = rig.write();
  const auto samples = rig.read();
  ASSERT_EQ(samples.size(), kAll);
  EXPECT_EQ(written.faults.clipped, 100U);
  for (std::size_t k = 0; k < kAll; ++k) {
    const double most = samples[k].accel_mps2.cwiseAbs().maxCoeff();
    EXPECT_EQ(most < 4.904, during(k)) << k;
  }
}

TEST(SimulatorImuFaults, AStepIsOnTheXAxis) {
  SimulatedImu rig = with_fault("imu_step", 2);
  rig.config = without_errors(rig.config);
  EXPECT_EQ(rig.write().faults.step, 100U);
  const auto samples = rig.read();
  for (std::size_t k = 0; k < kAll; ++k) {
    const Eigen::Vector3d step = samples[k].accel_mps2 - truth_at(rig, k).accel_mps2;
    EXPECT_LT((step - Eigen::Vector3d(during(k) ? 2 * kGravity_mps2 : 0, 0, 0)).norm(), 1e-5) << k;
  }
}

TEST(SimulatorImuFaults, NanIsOnTheWireAndRefusedByTheParser) {
  SimulatedImu rig = with_fault("imu_nan", 0);
  EXPECT_EQ(rig.write().faults.nan, 100U);
  EXPECT_EQ(rig.read().size(), kAll - 100);
  EXPECT_EQ(rig.rejected, (Rejections{{"non_finite", 100}}));
}

TEST(SimulatorImuFaults, AWitMotionHasNoNanAndSendsFullScale) {
  SimulatedImu rig = with_fault("imu_nan", 0);
  rig.config.protocol = ImuProtocol::kWitMotion;
  (void)rig.write();
  const auto samples = rig.read();
  ASSERT_EQ(samples.size(), kAll);
  for (std::size_t k = 0; k < kAll; ++k)
    EXPECT_EQ(samples[k].accel_mps2.x() < -15.9 * kStandardGravity_mps2, during(k)) << k;
}

TEST(SimulatorImuFaults, AStuckSensorRepeatsItself) {
  SimulatedImu rig = with_fault("imu_stuck", 0);
  EXPECT_EQ(rig.write().faults.stuck, 100U);
  const auto samples = rig.read();
  ASSERT_EQ(samples.size(), kAll);
  for (std::size_t k = 1; k < kAll; ++k) {
    EXPECT_EQ(samples[k].gyro_radps == samples[k - 1].gyro_radps, during(k)) << k;
    EXPECT_EQ(*samples[k].sensor_ns - *samples[k - 1].sensor_ns, 5'000'000);
  }
}

TEST(SimulatorImuFaults, ATimeStepMovesStampsButNotSamples) {
  SimulatedImu rig = with_fault("imu_time_step", -1);
  EXPECT_EQ(rig.write().faults.time_step, 100U);
  const auto samples = rig.read();
  for (std::size_t k = 0; k < kAll; ++k) {
    const RigTime t = rig.context().rig_time(static_cast<double>(k) * kPeriod_s);
    EXPECT_EQ(*samples[k].sensor_ns - t.ns(), during(k) ? -kNanosPerSecond : 0) << k;
  }
}

TEST(SimulatorImuFaults, SkewGathersAndStays) {
  SimulatedImu rig = with_fault("imu_skew", 1000);
  EXPECT_EQ(rig.write().faults.skew, 100U);
  const auto samples = rig.read();
  const auto ahead_us = [&](std::size_t k) {
    const RigTime t = rig.context().rig_time(static_cast<double>(k) * kPeriod_s);
    return static_cast<double>(*samples[k].sensor_ns - t.ns()) * 1e-3;
  };
  EXPECT_EQ(ahead_us(kBegin - 1), 0);
  EXPECT_NEAR(ahead_us(150), 252.5, 0.01);
  EXPECT_NEAR(ahead_us(kEnd), 500, 0.01);
  EXPECT_NEAR(ahead_us(kAll - 1), 500, 0.01);
}

TEST(SimulatorImuBadInput, ALineTooSlowIsToldBeforeWork) {
  SimulatedImu rig(1);
  rig.config.update_rate = 400;
  const auto written = write_imu(rig.context(), rig.config, rig.folder.path());
  ASSERT_FALSE(written.ok());
  EXPECT_EQ(written.error().message, "imu: found a baud_rate of 115200, wanted at least 152000 (400 Hz of vectornav)");
  EXPECT_TRUE(std::filesystem::is_empty(rig.folder.path()));
}

TEST(SimulatorImuBadInput, AClockBeforeItsEpochIsToldBeforeWork) {
  SimulatedImu rig(1);
  rig.config.clock.offset_s = -2e9;
  EXPECT_FALSE(check_imu(rig.context(), rig.config).ok());
  rig.config.clock.offset_s = -1.767e9;
  EXPECT_TRUE(check_imu(rig.context(), rig.config).ok());
  rig.config.protocol = ImuProtocol::kWitMotion;  // its calendar begins in 2000
  const Status status = check_imu(rig.context(), rig.config);
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("wanted the years 2000 to 2255"), std::string::npos);
}

TEST(SimulatorImuBadInput, AClockThatAFaultSetsBeforeItsEpochIsToldBeforeWork) {
  SimulatedImu rig(3, {{"imu_time_step", 1, 2, -10}});
  rig.config.clock.offset_s = -1'767'268'800 + 8;  // 8 s since start-up
  const Status status = check_imu(rig.context(), rig.config);
  ASSERT_FALSE(status.ok());
  EXPECT_NE(status.error().message.find("at 1 s"), std::string::npos) << status.error().message;
  rig.config.clock.offset_s += 2;
  EXPECT_TRUE(check_imu(rig.context(), rig.config).ok());
  rig.config.clock.offset_s = 0;
  rig.faults = sim::FaultPlan({{"imu_time_step", 1, 2, 1e10}});  // VectorNav's nanoseconds would wrap
  EXPECT_FALSE(check_imu(rig.context(), rig.config).ok());
}

TEST(SimulatorImuBadInput, AFolderThatCannotBeWrittenIsNamed) {
  SimulatedImu rig(1);
  const auto written = write_imu(rig.context(), rig.config, rig.folder / "none");
  ASSERT_FALSE(written.ok());
  EXPECT_NE(written.error().message.find("none/imu.serial: cannot be written"), std::string::npos);
}

Problems problems_of(const char* yaml, ImuConfig& config) {
  Problems problems;
  YamlSection section(YAML::Load(yaml), "imu", "scenario.yaml", problems);
  read_keys(section, config);
  section.reject_unknown();
  return problems;
}

TEST(SimulatorImuKeys, AreReadAndChecked) {
  ImuConfig config;
  const char* const sound =
      "{update_rate: 100, protocol: witmotion, baud_rate: 230400, gyro_bias_radps: 0, vibration_hz: 40}";
  EXPECT_TRUE(problems_of(sound, config).empty());
  EXPECT_EQ(config.update_rate, 100);
  EXPECT_EQ(config.protocol, ImuProtocol::kWitMotion);
  EXPECT_EQ(config.line.baud_rate, 230400);
  EXPECT_EQ(config.gyro_bias_radps, 0);
  EXPECT_EQ(config.vibration.frequency_hz, 40);
  EXPECT_EQ(problems_of("{update_rate: 0.005, protocol: nmea, gyro_biass: 1}", config).size(), 3U);
}

}  // namespace
}  // namespace lxd::sim::simulator_imu_faults_test
