// SPDX-License-Identifier: Apache-2.0
// How an IMU errs: scale and misalignment, bias and its random walk, white noise, vibration, saturation.
#pragma once

#include <string_view>

#include <Eigen/Core>

#include "tools/simulator/imu/imu_config.hpp"
#include "tools/simulator/random.hpp"

namespace lxd::sim {

// What an IMU senses, in its own frame.
struct Inertial {
  Eigen::Vector3d gyro_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_mps2 = Eigen::Vector3d::Zero();  // specific force: +g upwards at rest
};

// Three orthogonal sensors of one kind. Its numbers are continuous densities; period_s makes them discrete: white noise
// of density N has standard deviation N / sqrt(period), the walk's step K sqrt(period).
struct TriadConfig {
  double noise_density, random_walk, bias_sigma, scale_ppm, misalignment_rad, max, vibration, vibration_hz, period_s;
};

class TriadErrors {
 public:
  TriadErrors(const TriadConfig& config, Random random);

  // The sample of `truth` at t_s: white noise is drawn, afterwards the bias walks on by one period.
  Eigen::Vector3d measured(const Eigen::Vector3d& truth, double t_s);
  [[nodiscard]] const Eigen::Vector3d& bias() const { return bias_; }  // of the next sample

 private:
  Eigen::Vector3d normals(double sigma);

  Random random_;
  double noise_sigma_, walk_sigma_, max_, vibration_, vibration_radps_;
  Eigen::Matrix3d gain_;
  Eigen::Vector3d bias_, phases_rad_;
};

class ImuErrors {
 public:
  ImuErrors(const ImuConfig& config, std::uint64_t seed, std::string_view stream);

  Inertial measured(const Inertial& truth, double t_s);
  [[nodiscard]] Inertial bias() const { return {gyro_.bias(), accel_.bias()}; }  // of the next sample

 private:
  TriadErrors gyro_, accel_;
};

// Between samples, by true time: the sensor samples by its own clock, which may run fast.
double sample_period_s(const ImuConfig& config);

}  // namespace lxd::sim
