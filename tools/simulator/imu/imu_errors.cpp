// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/imu/imu_errors.hpp"

#include <cmath>
#include <numbers>
#include <string>

#include "tools/simulator/units.hpp"

namespace lxd::sim {
namespace {

TriadConfig gyro_of(const ImuConfig& c) {
  return {c.gyroscope_noise_density,
          c.gyroscope_random_walk,
          c.gyro_bias_radps,
          c.gyro_scale_ppm,
          c.misalignment_rad,
          c.gyro_max_radps,
          c.vibration.gyro_amplitude_radps,
          c.vibration.frequency_hz,
          sample_period_s(c)};
}

TriadConfig accel_of(const ImuConfig& c) {
  return {c.accelerometer_noise_density,
          c.accelerometer_random_walk,
          c.accel_bias_mps2,
          c.accel_scale_ppm,
          c.misalignment_rad,
          c.accel_max_mps2,
          c.vibration.amplitude_mps2,
          c.vibration.frequency_hz,
          sample_period_s(c)};
}

Eigen::Matrix3d drawn_gain(const TriadConfig& config, Random& random) {
  Eigen::Matrix3d gain;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      const bool own = row == column;
      gain(row, column) = own ? 1 + random.normal(config.scale_ppm * kPpm) : random.normal(config.misalignment_rad);
    }
  }
  return gain;
}

}  // namespace

double sample_period_s(const ImuConfig& config) {
  return 1 / (config.update_rate * (1 + config.clock.skew_ppm * kPpm));
}

TriadErrors::TriadErrors(const TriadConfig& config, Random random)
    : random_(random),
      noise_sigma_(config.noise_density / std::sqrt(config.period_s)),
      walk_sigma_(config.random_walk * std::sqrt(config.period_s)),
      max_(config.max),
      vibration_(config.vibration),
      vibration_radps_(2 * std::numbers::pi * config.vibration_hz),
      gain_(drawn_gain(config, random_)),
      bias_(normals(config.bias_sigma)) {
  for (double& phase : phases_rad_) phase = random_.uniform(0, 2 * std::numbers::pi);
}

// One by one: the order of the draws must not be the compiler's choice.
Eigen::Vector3d TriadErrors::normals(double sigma) {
  Eigen::Vector3d values = Eigen::Vector3d::Zero();
  if (sigma == 0) return values;
  for (double& value : values) value = random_.normal(sigma);
  return values;
}

Eigen::Vector3d TriadErrors::measured(const Eigen::Vector3d& truth, double t_s) {
  Eigen::Vector3d value = gain_ * truth + bias_ + normals(noise_sigma_);
  if (vibration_ != 0) value += vibration_ * (phases_rad_.array() + vibration_radps_ * t_s).sin().matrix();
  bias_ += normals(walk_sigma_);
  return value.cwiseMin(max_).cwiseMax(-max_);
}

ImuErrors::ImuErrors(const ImuConfig& config, std::uint64_t seed, std::string_view stream)
    : gyro_(gyro_of(config), Random(seed, std::string(stream) + ".gyro")),
      accel_(accel_of(config), Random(seed, std::string(stream) + ".accel")) {}

Inertial ImuErrors::measured(const Inertial& truth, double t_s) {
  return {gyro_.measured(truth.gyro_radps, t_s), accel_.measured(truth.accel_mps2, t_s)};
}

}  // namespace lxd::sim
