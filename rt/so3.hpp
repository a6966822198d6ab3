// SPDX-License-Identifier: Apache-2.0
// The rotation group SO(3), the one manifold of the product. Perturbation is on the right: R <- R Exp(dtheta), so a
// tangent lives in the frame that R maps from (T_world_body: the body). Tangents are rotation vectors in rad; double
// throughout; nothing here allocates, throws or fails: every finite argument has an answer.
//
// Formulas: Sola, Deray, Atchuthan, "A micro Lie theory for state estimation in robotics" (arXiv:1812.01537), appendix
// B; equation numbers in brackets are that paper's. rt/README.md derives the series used at tiny angles.
#pragma once

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lxd {

// The skew-symmetric matrix with hat(a) * b = a x b.
inline Eigen::Matrix3d hat(const Eigen::Vector3d& a) {
  Eigen::Matrix3d A;
  A << 0, -a.z(), a.y(),  //
      a.z(), 0, -a.x(),   //
      -a.y(), a.x(), 0;
  return A;
}

// Inverse of hat; of a matrix that is not skew-symmetric it takes the skew-symmetric part.
inline Eigen::Vector3d vee(const Eigen::Matrix3d& A) {
  return 0.5 * Eigen::Vector3d(A(2, 1) - A(1, 2), A(0, 2) - A(2, 0), A(1, 0) - A(0, 1));
}

namespace so3_detail {

// Below this angle the quotients are taken from their series, whose first left-out term is then under 3e-16 of the sum;
// above it cancellation costs less than 2e-15 of the matrix entries.
inline constexpr double kSeriesAngle_rad = 0.1;

// sin(x)/x; the library's sine is exact enough to divide by anything that is not 0.
inline double sinc(double x) { return x == 0.0 ? 1.0 : std::sin(x) / x; }

// (1 - cos t)/t^2 = sinc^2(t/2)/2: without cancellation at any angle.
inline double one_minus_cos_over_square(double t) {
  const double s = sinc(0.5 * t);
  return 0.5 * s * s;
}

// (t - sin t)/t^3.
inline double t_minus_sin_over_cube(double t) {
  const double t2 = t * t;
  if (t < kSeriesAngle_rad) return 1.0 / 6.0 - t2 * (1.0 / 120.0 - t2 * (1.0 / 5040.0 - t2 / 362880.0));
  return (t - std::sin(t)) / (t2 * t);
}

// (1 - (t/2) cot(t/2))/t^2; smooth through pi, its pole is at 2 pi.
inline double one_minus_half_cot_over_square(double t) {
  const double t2 = t * t;
  if (t < kSeriesAngle_rad) return 1.0 / 12.0 + t2 * (1.0 / 720.0 + t2 * (1.0 / 30240.0 + t2 / 1209600.0));
  const double half = 0.5 * t;
  return (1.0 - half * std::cos(half) / std::sin(half)) / t2;
}

}  // namespace so3_detail

// The rotation by |theta| rad about theta (132).
inline Eigen::Matrix3d Exp(const Eigen::Vector3d& theta) {
  const double t = theta.norm();
  const Eigen::Matrix3d T = hat(theta);
  return Eigen::Matrix3d::Identity() + so3_detail::sinc(t) * T + so3_detail::one_minus_cos_over_square(t) * (T * T);
}

// The rotation vector of R, |Log(R)| <= pi, by way of the unit quaternion, which loses no digits near pi (133 does).
// At exactly pi both signs of the axis are right and one of them is given. R must be orthonormal.
inline Eigen::Vector3d Log(const Eigen::Matrix3d& R) {
  const Eigen::Quaterniond q(R);
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  const double n = q.vec().norm();              // sin(t/2)
  if (n == 0.0) return (2.0 * sign) * q.vec();  // zero, or so small that its square underflows
  const double half = std::atan2(n, sign * q.w());
  return (sign * 2.0 * half / n) * q.vec();
}

// Right Jacobian: Exp(theta + d) = Exp(theta) Exp(Jr(theta) d) to first order in d (143).
inline Eigen::Matrix3d Jr(const Eigen::Vector3d& theta) {
  const double t = theta.norm();
  const Eigen::Matrix3d T = hat(theta);
  return Eigen::Matrix3d::Identity() - so3_detail::one_minus_cos_over_square(t) * T +
         so3_detail::t_minus_sin_over_cube(t) * (T * T);
}

// Its inverse: Log(Exp(theta) Exp(d)) = theta + Jr_inverse(theta) d to first order (144). |theta| < 2 pi, which Log
// always keeps.
inline Eigen::Matrix3d Jr_inverse(const Eigen::Vector3d& theta) {
  const double t = theta.norm();
  const Eigen::Matrix3d T = hat(theta);
  return Eigen::Matrix3d::Identity() + 0.5 * T + so3_detail::one_minus_half_cot_over_square(t) * (T * T);
}

// Nearest rotation to a matrix that rounding has taken off the group by little (one Newton step of the polar
// decomposition: error e becomes e^2).
inline Eigen::Matrix3d orthonormalized(const Eigen::Matrix3d& R) {
  return 0.5 * R * (3.0 * Eigen::Matrix3d::Identity() - R.transpose() * R);
}

}  // namespace lxd
