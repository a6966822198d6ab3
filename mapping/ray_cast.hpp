// SPDX-License-Identifier: Apache-2.0
// What a ray meets in the map (paper, "Mesh-Assisted Visual Depth Association"): the nearest surface, with the variance
// of its distance. Real-time thread; README, "Ray casting".
#pragma once

#include <Eigen/Core>

#include "mapping/lattice_walk.hpp"
#include "mapping/surface_map.hpp"

namespace lxd {

struct RayHit {
  Eigen::Vector3d position_m;  // world
  double distance_m;           // from the ray's origin
  Eigen::Vector3f normal;      // unit, world axes, against the ray
  float variance_m2;           // of distance_m: the surface's, divided by the squared cosine of the incidence
  bool front;                  // the ray comes from the side on which the LiDAR was
  bool seen;                   // a return fell on this very place; false: the surface between returns
};

// False: no surface within the range, the ray leaves the map's keys, or it is not of numbers and unit length.
bool cast_ray(const SurfaceMap& map, const Ray& ray, RayHit& hit) noexcept;

}  // namespace lxd
