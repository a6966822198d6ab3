// SPDX-License-Identifier: Apache-2.0
// The 18-dimensional state of the filter and its manifold operators (paper, "Generalized Filtering Framework").
#pragma once

#include <Eigen/Core>

#include "rt/pose.hpp"
#include "rt/so3.hpp"

namespace lxd {

inline constexpr int kStateDim = 18;
using StateVector = Eigen::Matrix<double, kStateDim, 1>;
using StateMatrix = Eigen::Matrix<double, kStateDim, kStateDim>;

// Where each block of the error state begins: delta theta, p, v, b_g, b_a, g.
enum StateBlock : int { kTheta = 0, kPosition = 3, kVelocity = 6, kGyroBias = 9, kAccelBias = 12, kGravity = 15 };

// Without an IMU the gyroscope is a virtual one that always reads zero, so that its bias is minus the body's rate: the
// constant-velocity model is then the inertial model with nothing measured, and shares its transition (design 6.9).
struct State {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();  // R_world_body
  Eigen::Vector3d p = Eigen::Vector3d::Zero();      // body in world, m
  Eigen::Vector3d v = Eigen::Vector3d::Zero();      // of the body in world, m/s
  Eigen::Vector3d b_g = Eigen::Vector3d::Zero();    // rad/s
  Eigen::Vector3d b_a = Eigen::Vector3d::Zero();    // m/s^2
  Eigen::Vector3d g = {0.0, 0.0, -9.81};            // in world, m/s^2

  [[nodiscard]] Pose pose() const { return {R, p}; }
};

// x [+] dx: R Exp(dtheta), sums elsewhere.
inline State boxplus(const State& x, const StateVector& dx) {
  State y = x;
  y.R = orthonormalized(x.R * Exp(dx.segment<3>(kTheta)));
  y.p += dx.segment<3>(kPosition);
  y.v += dx.segment<3>(kVelocity);
  y.b_g += dx.segment<3>(kGyroBias);
  y.b_a += dx.segment<3>(kAccelBias);
  y.g += dx.segment<3>(kGravity);
  return y;
}

// The dx with x [+] dx = y.
inline StateVector boxminus(const State& y, const State& x) {
  StateVector dx;
  dx.segment<3>(kTheta) = Log(x.R.transpose() * y.R);
  dx.segment<3>(kPosition) = y.p - x.p;
  dx.segment<3>(kVelocity) = y.v - x.v;
  dx.segment<3>(kGyroBias) = y.b_g - x.b_g;
  dx.segment<3>(kAccelBias) = y.b_a - x.b_a;
  dx.segment<3>(kGravity) = y.g - x.g;
  return dx;
}

// d((x [+] dx) [-] origin) / d dx at dx = 0, for e = x [-] origin: the identity but for the rotation.
inline StateMatrix boxminus_jacobian(const StateVector& e) {
  StateMatrix J = StateMatrix::Identity();
  J.block<3, 3>(kTheta, kTheta) = Jr_inverse(e.segment<3>(kTheta));
  return J;
}

}  // namespace lxd
