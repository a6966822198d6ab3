// SPDX-License-Identifier: Apache-2.0
#include "estimator/propagation.hpp"

#include <algorithm>

namespace lxd {

State propagate(const State& x, double dt_s) {
  State y = x;
  y.R = orthonormalized(x.R * Exp(-x.b_g * dt_s));
  y.p += x.v * dt_s;
  return y;
}

StateMatrix transition(const State& x, double dt_s) {
  const Eigen::Vector3d turn = -x.b_g * dt_s;
  StateMatrix F = StateMatrix::Identity();
  F.block<3, 3>(kTheta, kTheta) = Exp(turn).transpose();
  F.block<3, 3>(kTheta, kGyroBias) = -Jr(turn) * dt_s;
  F.block<3, 3>(kPosition, kVelocity) = Eigen::Matrix3d::Identity() * dt_s;
  return F;
}

// The integral of white acceleration over dt: dt^3/3, dt^2/2, dt. For the rotation the rate is minus the bias, which
// turns the sign of the cross term; the turn within dt is neglected in Q.
StateMatrix process_noise(const ConstantVelocityNoise& noise, double dt_s) {
  const double q_angular = noise.angular_acceleration_density * noise.angular_acceleration_density;
  const double q_linear = noise.acceleration_density * noise.acceleration_density;
  const double t1 = dt_s, t2 = dt_s * dt_s / 2, t3 = dt_s * dt_s * dt_s / 3;
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  StateMatrix Q = StateMatrix::Zero();
  Q.block<3, 3>(kTheta, kTheta) = q_angular * t3 * I;
  Q.block<3, 3>(kTheta, kGyroBias) = -q_angular * t2 * I;
  Q.block<3, 3>(kGyroBias, kTheta) = -q_angular * t2 * I;
  Q.block<3, 3>(kGyroBias, kGyroBias) = q_angular * t1 * I;
  Q.block<3, 3>(kPosition, kPosition) = q_linear * t3 * I;
  Q.block<3, 3>(kPosition, kVelocity) = q_linear * t2 * I;
  Q.block<3, 3>(kVelocity, kPosition) = q_linear * t2 * I;
  Q.block<3, 3>(kVelocity, kVelocity) = q_linear * t1 * I;
  return Q;
}

State held(const State& x, const Gap& gap) {
  State y = x;
  y.v *= gap.keep();
  y.b_g *= gap.keep();
  return y;
}

// Rates: x' = k x + noise of variance (1 - k^2) s^2, which forgets x and ends with s. Pose: moved on at an unknown rate
// for the time held, but for no longer than known_s: from farther off no surface is found again anyway.
StateMatrix held(const StateMatrix& P, const Gap& gap) {
  const double k = gap.keep();
  const double away_s = std::min(gap.span_s - gap.known_s, gap.known_s);
  StateMatrix out = P;
  for (const int rate : {kVelocity, kGyroBias}) {
    out.middleRows<3>(rate) *= k;
    out.middleCols<3>(rate) *= k;
  }
  const auto doubt = [&](int pose, int rate, double sigma) {
    out.diagonal().segment<3>(rate).array() += (1 - k * k) * sigma * sigma;
    out.diagonal().segment<3>(pose).array() += away_s * away_s * sigma * sigma;
  };
  doubt(kPosition, kVelocity, gap.unknown.speed_mps);
  doubt(kTheta, kGyroBias, gap.unknown.rate_radps);
  return out;
}

}  // namespace lxd
