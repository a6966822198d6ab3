// SPDX-License-Identifier: Apache-2.0
#include "estimator/point_to_mesh.hpp"

#include <cmath>

namespace lxd {
namespace {

// A query that is no number lands in some cell; what comes back is no number either, and must not enter the sums.
bool is_sound(const PointResidual& residual) {
  return std::isfinite(residual.r_m) && std::isfinite(residual.variance_m2) && residual.row.allFinite();
}

}  // namespace

PointResidual point_to_surface(const RegistrationPoint& point, const PathKnot& knot, const SurfaceHit& surface) {
  const Eigen::Vector3d n = surface.normal.cast<double>();
  PointResidual out{};
  out.r_m = surface.distance_m;
  out.variance_m2 = static_cast<double>(surface.variance_m2) + point.variance_m2;
  out.row = row_along(knot, point.p_body_m, n);
  return out;
}

bool surface_of(const RegistrationPoint& point, const SweepPath& path, const Eigen::Vector3d& lidar_body_m,
                const SurfaceMap& map, SurfaceHit& surface) noexcept {
  const Eigen::Vector3d beam = path.nearest_knot(point.offset_ns).R * (point.p_body_m - lidar_body_m);
  return map.nearest(path.to_world(point.p_body_m, point.offset_ns), surface, beam.normalized().cast<float>());
}

std::span<PointResidual> associate(std::span<const RegistrationPoint> points, const SweepPath& path,
                                   const Eigen::Vector3d& lidar_body_m, const SurfaceMap& map,
                                   std::span<PointResidual> storage) noexcept {
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const RegistrationPoint& point = points[i];
    SurfaceHit surface;
    if (!surface_of(point, path, lidar_body_m, map, surface)) continue;
    storage[count] = point_to_surface(point, path.nearest_knot(point.offset_ns), surface);
    storage[count].point = static_cast<std::uint32_t>(i);
    count += is_sound(storage[count]);
  }
  return storage.first(count);
}

LidarMatrix motion_of(std::span<const PointResidual> residuals, std::span<const RegistrationPoint> points,
                      const SweepPath& path) {
  constexpr std::size_t kSamples = 256;
  const std::size_t stride = residuals.size() / kSamples + 1;
  LidarMatrix sum = LidarMatrix::Zero();
  std::size_t count = 0;
  for (std::size_t i = 0; i < residuals.size(); i += stride, ++count) {
    const RegistrationPoint& point = points[residuals[i].point];
    sum += motion_of(path.nearest_knot(point.offset_ns), point.p_body_m);
  }
  return sum * (static_cast<double>(residuals.size()) / static_cast<double>(std::max<std::size_t>(count, 1)));
}

double agreement(std::span<const PointResidual> residuals) {
  double sum = 0;
  for (const PointResidual& residual : residuals) {
    const double ratio = residual.r_m / kAgreementTolerance_m;
    sum += 1 / (1 + ratio * ratio);
  }
  return sum / static_cast<double>(std::max<std::size_t>(residuals.size(), 1));
}

}  // namespace lxd
