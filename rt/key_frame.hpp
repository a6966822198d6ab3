// SPDX-License-Identifier: Apache-2.0
// The vocabulary that the filter's side and the back-end have in common: key frames go one way, the correction of the
// map the other. Nothing else of one is known to the other.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "rt/pose.hpp"
#include "rt/time.hpp"

namespace lxd {

// One pose of the filter's path that the back-end keeps.
struct KeyFrame {
  std::int64_t id = 0;  // 0, 1, 2, ... without gaps
  RigTime stamp;
  Pose T_world_body;  // as the filter has it
  // What the filter's own covariance says of the motion since the key frame before, T_before_this: [rotation (right: in
  // the axes of this body), position (axes of the body before)], rad and m. Zero for the first.
  Eigen::Matrix<double, 6, 6> motion_covariance = Eigen::Matrix<double, 6, 6>::Zero();
  double travelled_m = 0, turned_rad = 0;  // since the key frame before, along the path
  std::int64_t sub_mesh = 0;               // that the sweep was fused into; counts up without gaps
  std::optional<Eigen::Vector3d> up_body;  // unit; where an IMU has felt gravity
};

// The back-end's answer: what takes the filter's world to the map.
struct MapCorrection {
  RigTime stamp;
  Pose T_map_world;
};

}  // namespace lxd
