// SPDX-License-Identifier: Apache-2.0
// A return as the map takes it: deskewed, registered, with the variance that it brings.
#pragma once

#include <Eigen/Core>

namespace lxd {

struct MapPoint {
  Eigen::Vector3f position_m;  // relative to the origin that is handed over with the points; world axes
  float variance_m2;           // of the range and the beam's spread; not of the pose, which all points of a sweep share
};

}  // namespace lxd
