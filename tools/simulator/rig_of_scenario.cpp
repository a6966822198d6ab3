// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/rig_of_scenario.hpp"

#include <numbers>

#include "tools/simulator/lidar/livox_pattern.hpp"
#include "tools/simulator/lidar/ouster_metadata.hpp"

namespace lxd::sim {
namespace {

LidarRig rig_of(const OusterConfig& config, std::uint64_t seed) {
  LidarRig rig;
  rig.model = "spinning";
  rig.beams = config.beams;
  rig.columns = config.columns;
  rig.rate_hz = config.rate_hz;
  const auto [lowest, highest] = ouster_fov_deg(config, seed);
  rig.fov_deg = {lowest, highest};
  rig.range_m = {config.returns.range_min_m, config.returns.range_max_m};
  if (config.returns.range_sigma_m > 0) rig.range_sigma_m = config.returns.range_sigma_m;
  rig.T_reference_sensor = config.T_body_sensor;
  return rig;
}

LidarRig rig_of(const LivoxConfig& config, std::uint64_t) {
  LidarRig rig;
  rig.model = "livox";
  rig.rate_hz = static_cast<double>(kNanosPerSecond) / static_cast<double>(kLivoxFrame_ns);
  constexpr double kDegrees = 180 / std::numbers::pi;
  rig.fov_deg = {kLivoxLow_rad * kDegrees, kLivoxHigh_rad * kDegrees};
  rig.range_m = {config.returns.range_min_m, config.returns.range_max_m};
  if (config.returns.range_sigma_m > 0) rig.range_sigma_m = config.returns.range_sigma_m;
  rig.T_reference_sensor = config.T_body_sensor;
  return rig;
}

LidarRig rig_of(const LidarConfig& config, std::uint64_t seed) {
  return std::visit([&](const auto& lidar) { return rig_of(lidar, seed); }, config);
}

ImuRig rig_of(const ImuConfig& config) {
  ImuRig rig;
  rig.update_rate = config.update_rate;
  if (config.gyroscope_noise_density > 0) rig.gyroscope_noise_density = config.gyroscope_noise_density;
  if (config.accelerometer_noise_density > 0) rig.accelerometer_noise_density = config.accelerometer_noise_density;
  rig.gyroscope_random_walk = config.gyroscope_random_walk;
  rig.accelerometer_random_walk = config.accelerometer_random_walk;
  rig.protocol = name_of(config.protocol);
  rig.baud_rate = config.line.baud_rate;
  rig.T_reference_sensor = config.T_body_sensor;
  return rig;
}

CameraRig rig_of(const CameraConfig& config) {
  CameraRig rig;
  rig.distortion_model = config.distortion_model;
  rig.resolution = config.resolution;
  rig.intrinsics = config.intrinsics;
  rig.distortion_coeffs = config.distortion_coeffs;
  rig.rate_hz = config.rate_hz;
  rig.T_reference_sensor = config.T_body_sensor;
  return rig;
}

WheelRig rig_of(const WheelConfig& config) {
  WheelRig rig;
  rig.rate_hz = config.rate_hz;
  rig.protocol = config.protocol == WheelProtocol::toyota ? "toyota" : "agilex";
  rig.track_m = config.track_m;
  if (config.speed_sigma_mps > 0) rig.speed_sigma_mps = config.speed_sigma_mps;
  rig.T_reference_sensor = config.T_body_sensor;
  return rig;
}

GnssRig rig_of(const GnssConfig& config) {
  GnssRig rig;
  rig.rate_hz = config.rate_hz;
  rig.antenna_in_reference_m = config.antenna_in_reference_m;
  return rig;
}

bool is_identity(const Pose& T) { return T.R.isIdentity(0) && T.p.isZero(0); }

}  // namespace

Rig rig_of(const Scenario& scenario, std::uint64_t seed) {
  Rig rig;
  rig.reference = scenario.imu && is_identity(scenario.imu->T_body_sensor) ? "imu" : "body";
  rig.lidar0 = rig_of(scenario.lidar0, seed);
  if (scenario.lidar1) rig.lidar1 = rig_of(*scenario.lidar1, seed);
  if (scenario.imu) rig.imu = rig_of(*scenario.imu);
  if (scenario.camera0) rig.camera0 = rig_of(*scenario.camera0);
  if (scenario.wheel) rig.wheel = rig_of(*scenario.wheel);
  if (scenario.gnss) rig.gnss = rig_of(*scenario.gnss);
  return rig;
}

}  // namespace lxd::sim
