// SPDX-License-Identifier: Apache-2.0
// Does a sweep see through what is known? Where a body is not, beams go on through walls and parked cars of the map,
// even if what they end on agrees with some other surface: floors look alike everywhere, and so do rows of cars.
#pragma once

#include <span>

#include "estimator/point_to_mesh.hpp"

namespace lxd {

// Of some of the returns, evenly taken, the share that lies well behind a surface that was seen; 0..1. 0: no returns.
double pierced_share(std::span<const RegistrationPoint> points, const SweepPath& path,
                     const Eigen::Vector3d& lidar_body_m, const SurfaceMap& map) noexcept;

}  // namespace lxd
