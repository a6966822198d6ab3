// SPDX-License-Identifier: Apache-2.0
// Point-to-mesh residuals (paper, "LiDAR Point-to-Mesh Structural Constraints") for a sweep whose points were fired one
// after the other.
//
// r = n^T (R(tau) q + p(tau)) + d, with the pose at the point's own time, tau before the sweep's end; its row is
// row_along() of sweep_path.hpp. The paper's printed Jacobian is that of a left perturbation with the sign turned; this
// one is checked against numeric differentiation.
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "estimator/state.hpp"
#include "estimator/sweep_path.hpp"
#include "mapping/surface_map.hpp"

namespace lxd {

// A thinned return that takes part in the update.
struct RegistrationPoint {
  Eigen::Vector3d p_body_m;  // at its own firing time
  std::uint32_t offset_ns;
  float variance_m2;  // of the range and the beam's spread
};

struct PointResidual {
  double r_m;
  double variance_m2;   // of the residual: surface and sensor (design 6.2)
  LidarVector row;      // dr / d(end state)
  std::uint32_t point;  // its place in the registration
};

// The residual of a point against a given surface, at the path's knot nearest to the point's time.
PointResidual point_to_surface(const RegistrationPoint& point, const PathKnot& knot, const SurfaceHit& surface);

// The surface that a return belongs to: the nearest of those that look towards the LiDAR, which is at lidar_body_m (of
// a second LiDAR, beside it, the side of a wall is the same). False: none.
bool surface_of(const RegistrationPoint& point, const SweepPath& path, const Eigen::Vector3d& lidar_body_m,
                const SurfaceMap& map, SurfaceHit& surface) noexcept;

// Associates every point with its surface; returns the residuals found, in the points' order. All their numbers
// are finite, whatever the points' are.
std::span<PointResidual> associate(std::span<const RegistrationPoint> points, const SweepPath& path,
                                   const Eigen::Vector3d& lidar_body_m, const SurfaceMap& map,
                                   std::span<PointResidual> storage) noexcept;

// Sum of J^T J over the residuals' points, from a few hundred of them: how the points move with the end state.
LidarMatrix motion_of(std::span<const PointResidual> residuals, std::span<const RegistrationPoint> points,
                      const SweepPath& path);

// How well those returns that meet a surface agree with it, 0..1: at kAgreementTolerance_m from it a return speaks
// half. Empty: 0.
inline constexpr double kAgreementTolerance_m = 0.15;
double agreement(std::span<const PointResidual> residuals);

}  // namespace lxd
