// SPDX-License-Identifier: Apache-2.0
#include "estimator/pierced_surfaces.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/ray_cast.hpp"

namespace lxd {
namespace {

constexpr double kBehind_m = 0.3;  // across the surface: more than poses and noise are off by
constexpr double kBeside_m = 0.2;  // where a surface ends is known to a quad of the map only

// Does the map have a surface well before the beam's end?
bool goes_through(const SurfaceMap& map, const Ray& beam) {
  RayHit hit;
  if (!cast_ray(map, beam, hit) || !hit.seen) return false;
  return (beam.range_m - hit.distance_m) * -hit.normal.cast<double>().dot(beam.direction) > kBehind_m;
}

// And all about the beam, too, so that it does not pass by the surface's edge?
bool pierces(const SurfaceMap& map, const Ray& beam) {
  if (!goes_through(map, beam)) return false;
  const Eigen::Vector3d aside = kBeside_m * beam.direction.unitOrthogonal();
  const Eigen::Vector3d across = beam.direction.cross(aside);
  for (const Eigen::Vector3d& by : {aside, across, Eigen::Vector3d(-aside), Eigen::Vector3d(-across)})
    if (!goes_through(map, {beam.origin_m + by, beam.direction, beam.range_m})) return false;
  return true;
}

}  // namespace

double pierced_share(std::span<const RegistrationPoint> points, const SweepPath& path,
                     const Eigen::Vector3d& lidar_body_m, const SurfaceMap& map, std::size_t beams_wanted) noexcept {
  const std::size_t stride = points.size() / beams_wanted + 1;
  std::size_t beams = 0, pierced = 0;
  for (std::size_t i = 0; i < points.size(); i += stride, ++beams) {
    const PathKnot& knot = path.nearest_knot(points[i].offset_ns);
    const Eigen::Vector3d lidar = knot.R * lidar_body_m + knot.p;
    const Eigen::Vector3d way = knot.R * points[i].p_body_m + knot.p - lidar;
    const double range_m = way.norm();
    pierced += pierces(map, {lidar, way / range_m, range_m});
  }
  return static_cast<double>(pierced) / static_cast<double>(std::max<std::size_t>(beams, 1));
}

}  // namespace lxd
