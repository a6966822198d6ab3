// SPDX-License-Identifier: Apache-2.0
// A hand-held rig on a walk: steps at 2 Hz, sway, and a turn in between.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "tools/simulator/motion/trajectory.hpp"

namespace lxd::test {

inline Eigen::Vector3d walking_position_m(double t_s) {
  const double step = 2 * std::numbers::pi * 2 * t_s;
  return {1.2 * t_s + 0.01 * std::sin(step + 1), 0.03 * std::sin(0.5 * step) + 0.5 * std::sin(0.3 * t_s),
          1.4 + 0.02 * std::cos(step)};
}

inline Eigen::Quaterniond walking_rotation(double t_s) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  const double step = 2 * std::numbers::pi * 2 * t_s;
  return AngleAxisd(1.5 * std::sin(0.4 * t_s) + 0.03 * std::sin(0.5 * step), Vector3d::UnitZ()) *
         AngleAxisd(0.04 * std::cos(step + 0.5), Vector3d::UnitY()) *
         AngleAxisd(0.05 * std::sin(step) + 0.02 * std::sin(2.1 * step), Vector3d::UnitX());
}

// From 0 to at least seconds.
inline sim::Trajectory walking_motion(double seconds) {
  constexpr double kStep_s = 0.05;
  constexpr int kMargin = 8;  // control points beyond both ends
  std::vector<Eigen::Vector3d> positions_m;
  std::vector<Eigen::Quaterniond> rotations;
  const int count = static_cast<int>(seconds / kStep_s) + 2 * kMargin;
  for (int i = 0; i < count; ++i) {
    positions_m.push_back(walking_position_m((i - kMargin) * kStep_s));
    rotations.push_back(walking_rotation((i - kMargin) * kStep_s));
  }
  return {-kMargin * kStep_s, kStep_s, positions_m, rotations};
}

inline sim::Trajectory resting_motion(double seconds) {
  const std::vector<Eigen::Vector3d> positions_m(16, Eigen::Vector3d::Zero());
  const std::vector<Eigen::Quaterniond> rotations(16, Eigen::Quaterniond::Identity());
  return {-seconds, seconds / 4, positions_m, rotations};
}

}  // namespace lxd::test
