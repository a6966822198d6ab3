// SPDX-License-Identifier: Apache-2.0
// One fix of GNSS as the graph takes it.
#pragma once

#include <cstdint>

#include "rt/pose.hpp"
#include "rt/time.hpp"

namespace lxd {

struct GnssMeasurement {
  std::int64_t key_frame = 0;  // the one before it
  RigTime stamp;
  Eigen::Vector3d antenna_body_m;        // at the stamp, in that key frame's body: lever arm and motion since
  Eigen::Vector3d antenna_velocity_mps;  // likewise, in its axes
  Eigen::Vector3d enu_m;
  Eigen::Matrix3d covariance_m2;  // of enu_m
};

}  // namespace lxd
