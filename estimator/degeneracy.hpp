// SPDX-License-Identifier: Apache-2.0
// Which directions of the pose does the geometry hold? Where it does not, noise in the normals would still pretend to:
// the information along such a direction is taken out, so that the prior stands and the covariance grows (design 6.10).
#pragma once

#include <cstdint>

#include "estimator/normal_equations.hpp"

namespace lxd {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct Degeneracy {
  std::uint8_t directions = 0;           // how many of the six are not held
  Matrix6d axes = Matrix6d::Identity();  // columns: eigenvectors, rotation scaled by `lever_m` to metres; weakest first
  Vector6d sensitivity = Vector6d::Zero();  // mean squared sensitivity of a residual along each, 0..1
  Vector6d trust = Vector6d::Zero();        // share of each axis' information that is geometry and not noise, 0..1
  double lever_m = 1.0;                     // root mean square lever arm of the rotation
};

// noise: mean squared sensitivity that errors of the normals alone give along any direction, rad^2. A direction counts
// as not held when less than half of its information is geometry.
Degeneracy find_degeneracy(const NormalEquations& sums, double noise);

// Takes the share of noise out of the information along every axis, and of the gradient with it: what is left measures
// the same with a larger variance.
void discount(const Degeneracy& degeneracy, NormalEquations& sums);

}  // namespace lxd
