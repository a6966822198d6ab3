// SPDX-License-Identifier: Apache-2.0
// Relative poses with their doubt, put one after the other. A pose T_a_b errs by [rotation (right: axes of b), position
// (axes of a)]: R <- R Exp(dtheta), p <- p + dp, as rt/so3.hpp and the filter have it.
#pragma once

#include "backend/loop_measurement.hpp"
#include "rt/pose.hpp"

namespace lxd {

// T [+] d and the d that takes x to y.
Pose box_plus(const Pose& T, const Vector6d& d);
Vector6d box_minus(const Pose& y, const Pose& x);

struct RelativeMotion {
  Pose T;                                  // T_a_b
  Matrix6d covariance = Matrix6d::Zero();  // of it
};

// T_a_c of T_a_b and T_b_c, whose errors are independent.
RelativeMotion operator*(const RelativeMotion& ab, const RelativeMotion& bc);
// T_b_a of T_a_b.
RelativeMotion inverse_of(const RelativeMotion& ab);
// T_b_c of T_a_b and T_a_c where c was reached by way of b: takes the doubt up to b out again.
RelativeMotion between(const RelativeMotion& ab, const RelativeMotion& ac);

// Whether the two say the same of one relative pose; their errors are independent.
bool alike(const RelativeMotion& a, const RelativeMotion& b);

// The nearest covariance without negative variances.
Matrix6d without_negative(const Matrix6d& C);
// Upper triangular U with U^T U = C^-1; no variance counts as zero.
Matrix6d sqrt_information(const Matrix6d& covariance);

}  // namespace lxd
