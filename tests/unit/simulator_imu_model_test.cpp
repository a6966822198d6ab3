// SPDX-License-Identifier: Apache-2.0
// The simulated IMU against the motion that it is part of.
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/imu_integration.hpp"
#include "tests/support/walking_motion.hpp"
#include "tools/simulator/imu/imu_model.hpp"

namespace lxd::sim::simulator_imu_model_test {
namespace {

using test::DeadReckoning;

constexpr double kDegree = std::numbers::pi / 180;

Pose off_centre() {
  return {Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix(), {0.2, -0.1, 0.3}};
}

std::vector<Inertial> samples_of(const ImuConfig& config, const Trajectory& motion, std::size_t count) {
  ImuModel model(config, motion, 1, "imu");
  std::vector<Inertial> samples;
  while (samples.size() < count) samples.push_back(model.next().measured);
  return samples;
}

// From the true start over `seconds`; errors against the motion at the end.
struct Drift {
  double position_m, angle_rad;
};
Drift drift_after(const ImuConfig& config, const Trajectory& motion, int seconds) {
  const auto count = static_cast<std::size_t>(seconds * config.update_rate);
  const std::vector<Inertial> samples = samples_of(config, motion, count + 1);
  const double period_s = sample_period_s(config);
  DeadReckoning state = test::true_sensor_state(motion, config.T_body_sensor, 0);
  for (std::size_t k = 0; k + 2 < samples.size(); k += 2)
    state = test::integrated(state, std::span(samples).subspan(k).first<3>(), period_s);
  const double end_s = static_cast<double>(count) * period_s;
  const DeadReckoning truth = test::true_sensor_state(motion, config.T_body_sensor, end_s);
  return {(state.p_m - truth.p_m).norm(), state.q_world_sensor.angularDistance(truth.q_world_sensor)};
}

TEST(SimulatorImuModel, SamplesWithoutNoiseIntegrateToTheMotion) {
  const Trajectory motion = test::walking_motion(11);
  ImuConfig config = without_errors(ImuConfig{});
  const Drift central = drift_after(config, motion, 10);
  EXPECT_LT(central.position_m, 1e-3);
  EXPECT_LT(central.angle_rad, 0.01 * kDegree);

  config.T_body_sensor = off_centre();
  const Drift levered = drift_after(config, motion, 10);
  EXPECT_LT(levered.position_m, 1e-3);
  EXPECT_LT(levered.angle_rad, 0.01 * kDegree);
  RecordProperty("central_mm", std::to_string(central.position_m * 1e3));
  RecordProperty("levered_mm", std::to_string(levered.position_m * 1e3));
}

TEST(SimulatorImuModel, AFastSensorsSamplesIntegrateToo) {
  const Trajectory motion = test::walking_motion(11);
  ImuConfig config = without_errors(ImuConfig{});
  config.clock.skew_ppm = 500;  // given: its periods are shorter by true time
  const Drift drift = drift_after(config, motion, 10);
  EXPECT_LT(drift.position_m, 1e-3);
  EXPECT_LT(drift.angle_rad, 0.01 * kDegree);
}

TEST(SimulatorImuModel, AtRestItFeelsGravityUpwardsInItsOwnFrame) {
  const Trajectory motion = test::resting_motion(4);
  const Inertial level = true_inertial(motion, {}, 1);
  EXPECT_TRUE(level.accel_mps2.isApprox(Eigen::Vector3d(0, 0, kGravity_mps2), 1e-12));
  EXPECT_LT(level.gyro_radps.norm(), 1e-12);
  const Pose tilted = off_centre();
  const Inertial other = true_inertial(motion, tilted, 1);
  EXPECT_TRUE(other.accel_mps2.isApprox(tilted.R.transpose() * Eigen::Vector3d(0, 0, kGravity_mps2), 1e-12));
}

// Given the sensor's own path by differences of poses, then the lever arm's acceleration is that path's.
TEST(SimulatorImuModel, TheLeverArmAddsItsOwnAcceleration) {
  const Trajectory motion = test::walking_motion(4);
  const Pose T_body_sensor = off_centre();
  constexpr double kStep_s = 1e-4;
  const auto p = [&](double t_s) { return (motion.at(t_s).T_world_body * T_body_sensor).p; };
  for (const double t_s : {0.5, 1.3, 2.9}) {
    const Eigen::Vector3d a = (p(t_s + kStep_s) - 2 * p(t_s) + p(t_s - kStep_s)) / (kStep_s * kStep_s);
    const Eigen::Matrix3d R = motion.at(t_s).T_world_body.R * T_body_sensor.R;
    const Eigen::Vector3d wanted = R.transpose() * (a + Eigen::Vector3d(0, 0, kGravity_mps2));
    EXPECT_LT((true_inertial(motion, T_body_sensor, t_s).accel_mps2 - wanted).norm(), 1e-5);
  }
}

TEST(SimulatorImuModel, ErrorsAreBiasAndGainOfTheTruth) {
  const Trajectory motion = test::walking_motion(4);
  ImuConfig config;
  config.gyroscope_noise_density = config.accelerometer_noise_density = 0;
  config.gyro_scale_ppm = config.accel_scale_ppm = config.misalignment_rad = 0;
  ImuModel model(config, motion, 3, "imu");
  for (int k = 0; k < 100; ++k) {
    const ImuModelSample sample = model.next();
    EXPECT_TRUE(sample.measured.gyro_radps.isApprox(sample.truth.gyro_radps + sample.bias.gyro_radps, 1e-9));
    EXPECT_TRUE(sample.measured.accel_mps2.isApprox(sample.truth.accel_mps2 + sample.bias.accel_mps2, 1e-9));
    EXPECT_GT(sample.bias.accel_mps2.norm(), 1e-3);
  }
}

TEST(SimulatorImuModel, ItSaturates) {
  const Trajectory motion = test::walking_motion(4);
  ImuConfig config = without_errors(ImuConfig{});
  config.accel_max_mps2 = 9.0;
  config.gyro_max_radps = 0.1;
  double largest_gyro = 0;
  for (const Inertial& sample : samples_of(config, motion, 400)) {
    EXPECT_LE(sample.accel_mps2.cwiseAbs().maxCoeff(), 9.0);
    largest_gyro = std::max(largest_gyro, sample.gyro_radps.cwiseAbs().maxCoeff());
  }
  EXPECT_EQ(largest_gyro, 0.1);
}

TEST(SimulatorImuModel, VibrationIsASineOfItsAmplitude) {
  const Trajectory motion = test::resting_motion(4);
  ImuConfig config = without_errors(ImuConfig{});
  config.vibration = {2.0, 0.5, 7.0};
  double square = 0, largest = 0;
  const std::vector<Inertial> samples = samples_of(config, motion, 800);
  for (const Inertial& sample : samples) {
    square += sample.gyro_radps.x() * sample.gyro_radps.x();
    largest = std::max(largest, std::abs(sample.accel_mps2.y()));
  }
  EXPECT_NEAR(std::sqrt(2 * square / static_cast<double>(samples.size())), 0.5, 0.01);
  EXPECT_NEAR(largest, 2.0, 0.02);
}

TEST(SimulatorImuModel, ChanceBelongsToSeedAndStream) {
  const Trajectory motion = test::resting_motion(4);
  const auto first = [&](std::uint64_t seed, const char* stream) {
    return ImuModel({}, motion, seed, stream).next().measured.gyro_radps;
  };
  EXPECT_EQ(first(1, "imu"), first(1, "imu"));
  EXPECT_NE(first(1, "imu"), first(2, "imu"));
  EXPECT_NE(first(1, "imu"), first(1, "lidar0.imu"));
}

}  // namespace
}  // namespace lxd::sim::simulator_imu_model_test
