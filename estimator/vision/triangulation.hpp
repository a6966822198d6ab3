// SPDX-License-Identifier: Apache-2.0
// A point from the bearings of three frames or more (paper: Direct Linear Transformation). Real-time safe.
#pragma once

#include <span>

#include <Eigen/Core>

#include "rt/pose.hpp"

namespace lxd {

struct Sighting {
  Pose T_world_camera;
  Eigen::Vector3d bearing;  // unit, camera frame
};

struct Triangulation {
  Eigen::Vector3d p_world_m;
  Eigen::Matrix3d covariance_m2;  // by the bearings' noise alone
  double parallax_rad;            // the largest angle between two rays
};

inline constexpr std::size_t kSightingsMin = 3;

// False: fewer than three sightings, less parallax than wanted, behind a camera, or rays that miss the point by more
// than three sigma.
bool triangulate(std::span<const Sighting> sightings, double bearing_sigma_rad, double parallax_min_rad,
                 Triangulation& out) noexcept;

}  // namespace lxd
