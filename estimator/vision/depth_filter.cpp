// SPDX-License-Identifier: Apache-2.0
#include "estimator/vision/depth_filter.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lxd {
namespace {

// Observations share the errors of the poses they were made from: no distance is known better than this share of it.
constexpr double kRelativeSigmaMin = 0.003;

InverseDepth bounded(InverseDepth depth) {
  depth.rho = std::clamp(depth.rho, kInverseDistanceMin, kInverseDistanceMax);
  const double least = kRelativeSigmaMin * depth.rho;
  depth.variance = std::max(depth.variance, least * least);
  return depth;
}

}  // namespace

InverseDepth inverse_of(double distance_m, double variance_m2) {
  const double square = distance_m * distance_m;
  return bounded({1 / distance_m, variance_m2 / (square * square)});
}

InverseDepth fused(const InverseDepth& prior, const InverseDepth& observed) {
  const double K = prior.variance / (prior.variance + observed.variance);
  return bounded({prior.rho + K * (observed.rho - prior.rho), (1 - K) * prior.variance});
}

double squared_difference(const InverseDepth& a, const InverseDepth& b) {
  return (a.rho - b.rho) * (a.rho - b.rho) / (a.variance + b.variance);
}

// q = R b + rho t is the point times rho: its length n gives rho' = rho / n and d rho' / d rho = (1 + rho (R b)^T t) /
// n^3.
AnchoredPoint shifted(const AnchoredPoint& point, const Pose& T_new_old) {
  const double rho = point.depth.rho;
  const Eigen::Vector3d turned = T_new_old.R * point.bearing, q = turned + rho * T_new_old.p;
  const double n = q.norm(), slope = (1 + rho * turned.dot(T_new_old.p)) / (n * n * n);
  return {q / n, bounded({rho / n, slope * slope * point.depth.variance})};
}

double update_by_pixel(AnchoredPoint& point, const Pose& T_camera_anchor, const CameraModel& camera,
                       const Eigen::Vector2d& pixel, double sigma_px, double gate) {
  const Eigen::Vector3d q = T_camera_anchor.R * point.bearing + point.depth.rho * T_camera_anchor.p;
  Eigen::Vector2d expected;
  ProjectionJacobian J;
  if (!camera.project(q, expected, &J)) return std::numeric_limits<double>::infinity();
  const Eigen::Vector2d h = J * T_camera_anchor.p, r = pixel - expected;
  const double noise = sigma_px * sigma_px, hr = h.dot(r) / noise;
  const double variance = 1 / (1 / point.depth.variance + h.squaredNorm() / noise);
  const double squared = r.squaredNorm() / noise - variance * hr * hr;  // r^T (noise I + var h h^T)^-1 r
  if (!(squared < gate)) return std::isnan(squared) ? std::numeric_limits<double>::infinity() : squared;
  // All pixels are told from the one bearing at the anchor: together they know no more than the best of them alone.
  point.depth = bounded({point.depth.rho + variance * hr, std::min(point.depth.variance, noise / h.squaredNorm())});
  return squared;
}

}  // namespace lxd
