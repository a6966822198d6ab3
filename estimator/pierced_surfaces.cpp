// SPDX-License-Identifier: Apache-2.0
#include "estimator/pierced_surfaces.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/ray_cast.hpp"

namespace lxd {
namespace {

constexpr std::size_t kBeams = 300;
constexpr double kBehind_m = 0.3;  // across the surface: more than poses, noise and the edges of surfaces are off by

}  // namespace

double pierced_share(std::span<const RegistrationPoint> points, const SweepPath& path,
                     const Eigen::Vector3d& lidar_body_m, const SurfaceMap& map) noexcept {
  const std::size_t stride = points.size() / kBeams + 1;
  std::size_t beams = 0, pierced = 0;
  for (std::size_t i = 0; i < points.size(); i += stride, ++beams) {
    const PathKnot& knot = path.nearest_knot(points[i].offset_ns);
    const Eigen::Vector3d lidar = knot.R * lidar_body_m + knot.p;
    const Eigen::Vector3d way = knot.R * points[i].p_body_m + knot.p - lidar;
    const double range_m = way.norm();
    RayHit hit;
    if (!cast_ray(map, {lidar, way / range_m, range_m}, hit) || !hit.seen) continue;
    const double cosine = -hit.normal.cast<double>().dot(way) / range_m;
    pierced += (range_m - hit.distance_m) * cosine > kBehind_m;
  }
  return static_cast<double>(pierced) / static_cast<double>(std::max<std::size_t>(beams, 1));
}

}  // namespace lxd
