// SPDX-License-Identifier: Apache-2.0
// Does a sweep see through what is known? Where a body is not, beams go on through walls and parked cars of the map,
// even if what they end on agrees with some other surface: floors look alike everywhere, and so do rows of cars.
#pragma once

#include <span>

#include "estimator/point_to_mesh.hpp"

namespace lxd {

// Of some of the returns, evenly taken, the share whose beams go through a surface that was seen, well away from its
// edges, and end well behind it; 0..1. 0: no returns. Five rays a beam at most.
double pierced_share(std::span<const RegistrationPoint> points, const SweepPath& path,
                     const Eigen::Vector3d& lidar_body_m, const SurfaceMap& map, std::size_t beams_wanted) noexcept;

}  // namespace lxd
