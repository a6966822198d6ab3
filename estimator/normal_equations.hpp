// SPDX-License-Identifier: Apache-2.0
// What all residuals of a sweep say together: H^T W H and H^T W r, robustly weighted.
#pragma once

#include <span>

#include <Eigen/Core>

#include "estimator/point_to_mesh.hpp"

namespace lxd {

struct NormalEquations {
  LidarMatrix information = LidarMatrix::Zero();  // H^T W H
  LidarVector gradient = LidarVector::Zero();     // H^T W r
  double weight = 0;                              // trace of W, 1/m^2
  // sum w J^T J, of how the points themselves move with the state: what the normals' errors are multiplied by.
  LidarMatrix motion = LidarMatrix::Zero();
};

// Robust scale: 1.48 times the median of |r| / sigma, at least 1. `scratch` holds at least as many floats as residuals.
double residual_scale(std::span<const PointResidual> residuals, std::span<float> scratch);

// Weight of a residual: 1 / (scale^2 variance), times the Geman-McClure weight of r, whose kernel is `kernel_sigmas`
// scaled standard deviations wide.
struct RobustWeight {
  double scale, kernel_sigmas;
  [[nodiscard]] double of(const PointResidual& residual) const;
};

NormalEquations accumulate(std::span<const PointResidual> residuals, double scale, double kernel_sigmas);

// The Geman-McClure weight, 0..1, of a residual of `squared_ratio` squared scaled standard deviations.
double geman_mcclure(double squared_ratio, double squared_kernel);

// The kernel of an iteration: wide at first, so that a poor prediction still finds its surfaces, then narrow.
double kernel_sigmas(int iteration);

}  // namespace lxd
