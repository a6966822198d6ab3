// SPDX-License-Identifier: Apache-2.0
// The sensors on the carrier: a spinning LiDAR and an IMU with bias, both with white noise.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "rt/pose.hpp"
#include "tools/boxroom/motion.hpp"
#include "tools/boxroom/noise.hpp"
#include "tools/boxroom/world.hpp"

namespace lxd::boxroom {

inline constexpr int kColumns = 1024;  // firings a turn
inline constexpr double kSweepPeriod_s = 0.1;
inline constexpr double kImuPeriod_s = 0.005;

// Where the LiDAR sits on the body.
[[nodiscard]] Pose body_lidar();

// One turn of the LiDAR, as it flies (x y z intensity t_offset_s a point) and as if it had stood still at the turn's
// first firing (x y z intensity a point). Sensor frame, metres; intensity is the beam's number.
struct Turn {
  std::vector<float> moving;
  std::vector<float> frozen;
};

[[nodiscard]] Turn scan(const World& world, const Motion& motion, int beams, double begin_s, Noise& noise);

struct ImuSample {
  Eigen::Vector3d angular_rate_rad_s;
  Eigen::Vector3d specific_force_m_s2;  // body frame; at rest it points up
};

[[nodiscard]] ImuSample measure(const Motion& motion, double t_s, Noise& noise);

}  // namespace lxd::boxroom
