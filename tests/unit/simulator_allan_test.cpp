// SPDX-License-Identifier: Apache-2.0
// The noise of a simulated IMU at rest, seen by its Allan deviation: it must be what the densities say.
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/allan_deviation.hpp"
#include "tools/simulator/imu/imu_errors.hpp"

namespace lxd::sim::simulator_allan_test {
namespace {

// Six series, gyroscope and accelerometer, of an IMU at rest on a table.
struct Recorded {
  std::array<std::vector<double>, 3> gyro, accel;
};

Recorded record(const ImuConfig& config, double seconds, std::uint64_t seed) {
  ImuErrors errors(config, seed, "imu");
  const Inertial truth{{0, 0, 0}, {0, 0, 9.80665}};
  const auto count = static_cast<std::size_t>(seconds * config.update_rate);
  Recorded recorded;
  for (std::size_t k = 0; k < count; ++k) {
    const Inertial sample = errors.measured(truth, static_cast<double>(k) * sample_period_s(config));
    for (int axis = 0; axis < 3; ++axis) {
      recorded.gyro[axis].push_back(sample.gyro_radps[axis]);
      recorded.accel[axis].push_back(sample.accel_mps2[axis]);
    }
  }
  return recorded;
}

std::vector<Recorded> recordings(const ImuConfig& config, double seconds, int seeds) {
  std::vector<Recorded> recorded;
  for (int seed = 0; seed < seeds; ++seed) recorded.push_back(record(config, seconds, seed));
  return recorded;
}

struct Deviations {
  double gyro = 0, accel = 0;
};

// Root of the variance's mean over all axes and recordings.
Deviations measured(const std::vector<Recorded>& recorded, double update_rate, double tau_s) {
  const auto averaged = static_cast<std::size_t>(std::lround(tau_s * update_rate));
  Deviations sum;
  for (const Recorded& one : recorded) {
    for (int axis = 0; axis < 3; ++axis) {
      sum.gyro += test::allan_variance(one.gyro[axis], 1 / update_rate, averaged);
      sum.accel += test::allan_variance(one.accel[axis], 1 / update_rate, averaged);
    }
  }
  const double series = 3 * static_cast<double>(recorded.size());
  return {std::sqrt(sum.gyro / series), std::sqrt(sum.accel / series)};
}

void expect_within_a_tenth(double found, double wanted) {
  EXPECT_NEAR(found / wanted, 1, 0.1) << "found " << found << ", wanted " << wanted;
}

TEST(SimulatorAllan, WhiteNoiseReadsItsDensityAtOneSecond) {
  ImuConfig config;
  config.gyroscope_random_walk = config.accelerometer_random_walk = 0;
  const Deviations found = measured(recordings(config, 600, 1), config.update_rate, 1);
  expect_within_a_tenth(found.gyro, config.gyroscope_noise_density);
  expect_within_a_tenth(found.accel, config.accelerometer_noise_density);
}

TEST(SimulatorAllan, RandomWalkReadsItsDensityAtLongTimes) {
  ImuConfig config;
  config.update_rate = 20;
  config.gyroscope_noise_density = config.accelerometer_noise_density = 0;
  constexpr double kTau_s = 60;
  const Deviations found = measured(recordings(config, 15'000, 1), config.update_rate, kTau_s);
  expect_within_a_tenth(found.gyro, config.gyroscope_random_walk * std::sqrt(kTau_s / 3));
  expect_within_a_tenth(found.accel, config.accelerometer_random_walk * std::sqrt(kTau_s / 3));
}

// The defaults of the rig file, biases, scale and all: neither constant nor gain is noise.
TEST(SimulatorAllan, DefaultSensorReadsBothDensities) {
  ImuConfig config;
  config.update_rate = 50;
  const std::vector<Recorded> recorded = recordings(config, 5000, 2);
  for (const double tau_s : {0.1, 1.0, 10.0, 60.0}) {
    const Deviations found = measured(recorded, config.update_rate, tau_s);
    expect_within_a_tenth(found.gyro, std::sqrt(test::allan_variance_of(config.gyroscope_noise_density,
                                                                        config.gyroscope_random_walk, tau_s)));
    expect_within_a_tenth(found.accel, std::sqrt(test::allan_variance_of(config.accelerometer_noise_density,
                                                                         config.accelerometer_random_walk, tau_s)));
  }
}

TEST(SimulatorAllan, DensitiesHoldAtAnyRate) {
  for (const double rate : {25.0, 400.0}) {
    ImuConfig config;
    config.update_rate = rate;
    config.gyroscope_random_walk = config.accelerometer_random_walk = 0;
    const Deviations found = measured(recordings(config, 100'000 / rate, 1), rate, 0.4);
    expect_within_a_tenth(found.gyro, config.gyroscope_noise_density / std::sqrt(0.4));
    expect_within_a_tenth(found.accel, config.accelerometer_noise_density / std::sqrt(0.4));
  }
}

}  // namespace
}  // namespace lxd::sim::simulator_allan_test
