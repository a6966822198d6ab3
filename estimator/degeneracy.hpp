// SPDX-License-Identifier: Apache-2.0
// Which directions does the geometry hold? Where it does not, noise in the normals would still pretend to: the
// information along such a direction is taken out, so that the prior stands and the covariance grows (design 6.10).
//
// If the state is wrong by v, points move by J v, and an error e of a normal shows as e^T J v in its residual: normals
// that err by sigma_n give v^T N v = sigma_n^2 sum w |J v|^2 of information along any v, though nothing holds it.
#pragma once

#include <cstdint>

#include "estimator/normal_equations.hpp"

namespace lxd {

struct Degeneracy {
  std::uint8_t directions = 0;              // how many of the pose's six are not held
  Vector6d sensitivity = Vector6d::Zero();  // of the pose: information over noise along the axes of both, weakest first
  // Directions of [theta, p, v, b_g] that are independent in the prior and in the measurement (columns), their duals,
  // and the share of each one's information that is geometry and not noise, 0..1.
  LidarMatrix axes = LidarMatrix::Identity(), duals = LidarMatrix::Identity();
  LidarVector information = LidarVector::Zero(), trust = LidarVector::Zero();
};

// normal_variance: of the normals, rad^2. prior_root: L of the prior's covariance L L^T of [theta, p, v, b_g].
// A direction counts as not held when its information is less than twice the noise, and then none of it is believed.
//
// The directions are those of the prior and not the geometry's own: where a heading is known to a degree and the tilt
// to a hundredth of one, an error of a thousandth in what counts as tilt would turn the heading.
Degeneracy find_degeneracy(const NormalEquations& sums, const LidarMatrix& prior_root, double normal_variance);

// Takes the share of noise out of the information along every axis, and of the gradient with it: what is left measures
// the same with a larger variance.
void discount(const Degeneracy& degeneracy, NormalEquations& sums);

}  // namespace lxd
