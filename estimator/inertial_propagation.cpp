// SPDX-License-Identifier: Apache-2.0
#include "estimator/inertial_propagation.hpp"

namespace lxd {
namespace {

constexpr double kMeanTime = 1.0 / 2, kEarlyTime = 1.0 / 3;  // of the span: where velocity and position see the force

struct Unbiased {
  Eigen::Vector3d turn;   // over the whole span, rad
  Eigen::Vector3d force;  // m/s^2
};

Unbiased unbiased(const State& x, const InertialSpan& m) {
  return {(m.rate_radps - x.b_g) * m.span_s, m.force_mps2 - x.b_a};
}

void fill_noise(StateMatrix& Q, StateBlock value, StateBlock slope, const Eigen::Matrix3d& block) {
  Q.block<3, 3>(value, slope) = block;
  Q.block<3, 3>(slope, value) = block;
}

}  // namespace

State propagate(const State& x, const InertialSpan& m) {
  const Unbiased u = unbiased(x, m);
  const double t = m.span_s;
  State y = x;
  y.R = orthonormalized(x.R * Exp(u.turn));
  y.v += (x.R * (Exp(kMeanTime * u.turn) * u.force) + x.g) * t;
  y.p += x.v * t + (x.R * (Exp(kEarlyTime * u.turn) * u.force) + x.g) * (t * t / 2);
  return y;
}

// With R <- R Exp(dtheta): R Exp(dtheta) f = R f - R [f]x dtheta, and Exp(c (turn - db_g t)) f, turned with the bias,
// = Exp(c turn) (f + [f]x Jr(c turn) c t db_g).
StateMatrix transition(const State& x, const InertialSpan& m) {
  const Unbiased u = unbiased(x, m);
  const double t = m.span_s, half_square = t * t / 2;
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d mean = Exp(kMeanTime * u.turn), early = Exp(kEarlyTime * u.turn);
  const Eigen::Matrix3d mean_by_bias = mean * hat(u.force) * Jr(kMeanTime * u.turn) * (kMeanTime * t);
  const Eigen::Matrix3d early_by_bias = early * hat(u.force) * Jr(kEarlyTime * u.turn) * (kEarlyTime * t);
  StateMatrix F = StateMatrix::Identity();
  F.block<3, 3>(kTheta, kTheta) = Exp(u.turn).transpose();
  F.block<3, 3>(kTheta, kGyroBias) = -Jr(u.turn) * t;
  F.block<3, 3>(kVelocity, kTheta) = -x.R * hat(mean * u.force) * t;
  F.block<3, 3>(kVelocity, kGyroBias) = x.R * mean_by_bias * t;
  F.block<3, 3>(kVelocity, kAccelBias) = -x.R * mean * t;
  F.block<3, 3>(kVelocity, kGravity) = I * t;
  F.block<3, 3>(kPosition, kTheta) = -x.R * hat(early * u.force) * half_square;
  F.block<3, 3>(kPosition, kVelocity) = I * t;
  F.block<3, 3>(kPosition, kGyroBias) = x.R * early_by_bias * half_square;
  F.block<3, 3>(kPosition, kAccelBias) = -x.R * early * half_square;
  F.block<3, 3>(kPosition, kGravity) = I * half_square;
  return F;
}

// White noise on the rate walks the attitude, white noise on the force the velocity, whose integral is the position;
// the biases walk by themselves. What they do to the rest within the span is of its third order and left out.
StateMatrix process_noise(const ImuNoise& noise, double span_s) {
  const Eigen::Matrix3d I = Eigen::Matrix3d::Identity();
  const double t = span_s, force = noise.accel_density * noise.accel_density;
  StateMatrix Q = StateMatrix::Zero();
  Q.block<3, 3>(kTheta, kTheta) = noise.gyro_density * noise.gyro_density * t * I;
  Q.block<3, 3>(kVelocity, kVelocity) = force * t * I;
  Q.block<3, 3>(kPosition, kPosition) = force * (t * t * t / 3) * I;
  fill_noise(Q, kPosition, kVelocity, force * (t * t / 2) * I);
  Q.block<3, 3>(kGyroBias, kGyroBias) = noise.gyro_walk * noise.gyro_walk * t * I;
  Q.block<3, 3>(kAccelBias, kAccelBias) = noise.accel_walk * noise.accel_walk * t * I;
  return Q;
}

}  // namespace lxd
