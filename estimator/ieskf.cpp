// SPDX-License-Identifier: Apache-2.0
#include "estimator/ieskf.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

namespace lxd {
namespace {

// A prior that is certain would make P singular: this much is always open. (rad, m, m/s, rad/s)^2
constexpr double kVarianceFloor = 1e-12;
// What sweeps say of the IMU's delay is wrong alike in so many of them.
constexpr double kSweepsAlike = 10;

}  // namespace

void Ieskf::reset(const State& x, const StateMatrix& P) {
  x_ = prior_ = x;
  P_ = P;
  delay_.forget();
  mount_.forget();
}

void Ieskf::propagate_covariance(const StateMatrix& F, const StateMatrix& Q) {
  P_ = (F * P_ * F.transpose() + Q).eval();
  P_ = 0.5 * (P_ + P_.transpose()).eval();
}

void Ieskf::predict(double dt_s, const ConstantVelocityNoise& noise) {
  propagate_covariance(transition(x_, dt_s), process_noise(noise, dt_s));
  x_ = prior_ = propagate(x_, dt_s);
}

void Ieskf::predict(const InertialSpan& measured, const ImuNoise& noise) {
  const StateMatrix F = transition(x_, measured);
  propagate_covariance(F, process_noise(noise, measured.span_s));
  delay_.predict(F, measured);
  mount_.predict(F, measured);
  x_ = prior_ = propagate(x_, measured);
}

void Ieskf::predict_across(const Gap& gap, const ConstantVelocityNoise& noise) {
  predict(gap.known_s, noise);
  P_ = held(P_, gap);
  x_ = prior_ = held(x_, gap);
}

void Ieskf::begin_update() {
  free_ = (P_.diagonal().array() > 0).cast<double>();
  const StateMatrix P = P_ + kVarianceFloor * StateMatrix::Identity();
  const Eigen::LLT<StateMatrix> factors(P);
  sound_ = factors.info() == Eigen::Success;
  prior_information_ = factors.solve(StateMatrix::Identity());
  const LidarMatrix lidar = P.topLeftCorner<kLidarDim, kLidarDim>();
  const Eigen::LLT<LidarMatrix> root(lidar);
  prior_root_ = root.matrixL();
  prior_lidar_information_ = root.solve(LidarMatrix::Identity());
}

StateVector Ieskf::expected(StateBlock at, const Eigen::Vector3d& value) const {
  const Eigen::Matrix3d variance = P_.block<3, 3>(at, at) + kVarianceFloor * Eigen::Matrix3d::Identity();
  return P_.middleCols<3>(at) * variance.llt().solve(value);
}

// min |e + J dx|^2_P + sum |r + H dx|^2: (H^T W H + J^T P^-1 J) dx = -(H^T W r + J^T P^-1 e), e = x [-] prior. What is
// frozen has the floor for its variance and nothing that pulls: its dx is zero.
StateVector Ieskf::iterate(const NormalEquations& measured) {
  const StateVector e = boxminus(x_, prior_);
  const StateMatrix J = boxminus_jacobian(e);
  const StateMatrix JtP = J.transpose() * prior_information_;
  measured_information_ = measured.information;
  information_ = JtP * J;
  information_.topLeftCorner<kLidarDim, kLidarDim>() += measured_information_;
  StateVector gradient = JtP * e;
  gradient.head<kLidarDim>() += measured.gradient;
  const Eigen::LLT<StateMatrix> factors(information_);
  sound_ = sound_ && factors.info() == Eigen::Success && information_.allFinite();
  const StateVector dx = -factors.solve(gradient).cwiseProduct(free_);
  x_ = boxplus(x_, dx);
  return dx;
}

LidarVector Ieskf::prior_pull() const { return prior_information_.topRows<kLidarDim>() * boxminus(x_, prior_); }

bool Ieskf::conclude(const DelaySums& skew, bool tells_mount) {
  const StateMatrix P = information_.llt().solve(StateMatrix::Identity());
  if (!sound_ || !boxminus(x_, prior_).allFinite() || !P.allFinite()) {
    abandon();
    return false;
  }
  P_ = free_.asDiagonal() * (0.5 * (P + P.transpose())) * free_.asDiagonal();
  const StateVector correction = boxminus(x_, prior_);
  innovation_ = lxd::innovation(prior_lidar_information_, measured_information_, correction.head<kLidarDim>());
  const double doubt = kSweepsAlike * std::max(1.0, innovation_.per_dimension());
  const UpdateRecord record{prior_information_, measured_information_, P_, correction, doubt, skew};
  delay_.update(record);
  x_ = boxplus(x_, mount_.update(record, tells_mount));
  return true;
}

Calibration Ieskf::calibration() const { return {x_.b_g, x_.b_a, x_.g, P_.block<9, 9>(kGyroBias, kGyroBias)}; }

void Ieskf::replace(const Calibration& calibration) {
  x_.b_g = calibration.b_g;
  x_.b_a = calibration.b_a;
  x_.g = calibration.g;
  prior_ = x_;
  P_.bottomRows<9>().setZero();
  P_.rightCols<9>().setZero();
  P_.block<9, 9>(kGyroBias, kGyroBias) = calibration.P;
  delay_.forget();
  mount_.forget();
}

}  // namespace lxd
