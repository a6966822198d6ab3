// SPDX-License-Identifier: Apache-2.0
// Point-to-mesh residuals (paper, "LiDAR Point-to-Mesh Structural Constraints") for a sweep whose points were fired one
// after the other.
//
// r = n^T (R(tau) q + p(tau)) + d, with the pose at the point's own time, tau before the sweep's end (SweepPath). With
// R <- R Exp(dtheta) and a = Exp(psi) (q x R(tau)^T n), the lever in the end's body frame, the row is
//   dtheta: a^T,   dp: n^T,   dv: -tau n^T,   db_g: tau a^T Jl(psi).
// The paper's printed Jacobian is that of a left perturbation with the sign turned; this one is checked against numeric
// differentiation.
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

// The blocks of the state that a sweep of LiDAR points speaks of: theta, p, v, b_g.
inline constexpr int kLidarDim = 12;
using LidarVector = Eigen::Matrix<double, kLidarDim, 1>;
using LidarMatrix = Eigen::Matrix<double, kLidarDim, kLidarDim>;

struct PointResidual {
  double r_m;
  double variance_m2;  // of the residual: surface and sensor (design 6.2)
  LidarVector row;     // dr / d(end state)
};

// The residual of a point against a given surface, at the path's knot nearest to the point's time.
PointResidual point_to_surface(const RegistrationPoint& point, const PathKnot& knot, const SurfaceHit& surface);

// Associates every point with its nearest surface; returns the residuals found, in the points' order. All their numbers
// are finite, whatever the points' are.
std::span<PointResidual> associate(std::span<const RegistrationPoint> points, const SweepPath& path,
                                   const SurfaceMap& map, std::span<PointResidual> storage) noexcept;

// How well those returns that meet a surface agree with it, 0..1: at kAgreementTolerance_m from it a return speaks
// half. Empty: 0.
inline constexpr double kAgreementTolerance_m = 0.15;
double agreement(std::span<const PointResidual> residuals);

}  // namespace lxd
