// SPDX-License-Identifier: Apache-2.0
// Both LiDAR views share each firing's noise, so that they differ by the motion and by nothing else.
#include "tools/boxroom/sensors.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace lxd::boxroom {
namespace {

using Eigen::Vector3d;

constexpr double kPi = std::numbers::pi;
constexpr double kElevationLow_rad = -25 * kPi / 180;
constexpr double kElevationHigh_rad = 15 * kPi / 180;
constexpr double kRangeMax_m = 80;
constexpr double kRangeSigma_m = 0.01;

constexpr double kGyroSigma_rad_s = 0.0015;
constexpr double kForceSigma_m_s2 = 0.02;
constexpr double kDifferenceStep_s = 1e-4;  // of the numeric derivatives that make the IMU's truth

Vector3d direction(double azimuth_rad, double elevation_rad) {
  return {std::cos(elevation_rad) * std::cos(azimuth_rad), std::cos(elevation_rad) * std::sin(azimuth_rad),
          std::sin(elevation_rad)};
}

// True, and the point in the sensor's frame, when something is within range.
bool fire(const World& world, const Pose& T_world_lidar, const Vector3d& ray, double error_m, Vector3d& p_lidar) {
  const double range_m = world.range_m(T_world_lidar.p, T_world_lidar.R * ray);
  p_lidar = ray * (range_m + error_m);
  return range_m < kRangeMax_m;
}

void append(std::vector<float>& points, const Vector3d& p, int beam) {
  points.insert(points.end(), {static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()),
                               static_cast<float>(beam)});
}

}  // namespace

Pose body_lidar() {
  Pose T_body_lidar;
  T_body_lidar.R =
      (Eigen::AngleAxisd(0.10, Vector3d::UnitZ()) * Eigen::AngleAxisd(0.03, Vector3d::UnitY())).toRotationMatrix();
  T_body_lidar.p = Vector3d(0.05, -0.03, 0.12);
  return T_body_lidar;
}

Turn scan(const World& world, const Motion& motion, int beams, double begin_s, Noise& noise) {
  const Pose T_frozen = motion.world_body(begin_s) * body_lidar();
  Turn turn;
  for (int column = 0; column < kColumns; ++column) {
    const double offset_s = kSweepPeriod_s * column / kColumns;
    const double azimuth_rad = -2 * kPi * column / kColumns + kPi;  // clockwise, from the rear
    const Pose T_moving = motion.world_body(begin_s + offset_s) * body_lidar();
    for (int beam = 0; beam < beams; ++beam) {
      const double elevation_rad = kElevationLow_rad + (kElevationHigh_rad - kElevationLow_rad) * beam / (beams - 1);
      const Vector3d ray = direction(azimuth_rad, elevation_rad);
      const double error_m = noise.normal(kRangeSigma_m);
      Vector3d p_lidar;
      if (fire(world, T_frozen, ray, error_m, p_lidar)) append(turn.frozen, p_lidar, beam);
      if (fire(world, T_moving, ray, error_m, p_lidar)) {
        append(turn.moving, p_lidar, beam);
        turn.moving.push_back(static_cast<float>(offset_s));
      }
    }
  }
  return turn;
}

ImuSample measure(const Motion& motion, double t_s, Noise& noise) {
  const Vector3d gyro_bias_rad_s(0.002, -0.001, 0.0015), force_bias_m_s2(0.02, -0.015, 0.01), gravity_m_s2(0, 0, -9.81);
  const double h_s = kDifferenceStep_s;
  const Pose before = motion.world_body(t_s - h_s), now = motion.world_body(t_s), after = motion.world_body(t_s + h_s);
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(before.R.transpose() * after.R));
  const Vector3d acceleration_m_s2 = (after.p - 2 * now.p + before.p) / (h_s * h_s);
  ImuSample sample{turn.axis() * turn.angle() / (2 * h_s), now.R.transpose() * (acceleration_m_s2 - gravity_m_s2)};
  for (int axis = 0; axis < 3; ++axis) {
    sample.angular_rate_rad_s[axis] += gyro_bias_rad_s[axis] + noise.normal(kGyroSigma_rad_s);
    sample.specific_force_m_s2[axis] += force_bias_m_s2[axis] + noise.normal(kForceSigma_m_s2);
  }
  return sample;
}

}  // namespace lxd::boxroom
