// SPDX-License-Identifier: Apache-2.0
#include "estimator/ieskf.hpp"

#include <Eigen/Cholesky>

namespace lxd {
namespace {

// A prior that is certain would make P singular: this much is always open. (rad, m, m/s, rad/s)^2
constexpr double kVarianceFloor = 1e-12;

}  // namespace

void Ieskf::reset(const State& x, const StateMatrix& P) {
  x_ = prior_ = x;
  P_ = P;
}

void Ieskf::predict(double dt_s, const ConstantVelocityNoise& noise) {
  const StateMatrix F = transition(x_, dt_s);
  P_ = F * P_ * F.transpose() + process_noise(noise, dt_s);
  P_ = 0.5 * (P_ + P_.transpose()).eval();
  x_ = prior_ = propagate(x_, dt_s);
}

void Ieskf::predict_across(const Gap& gap, const ConstantVelocityNoise& noise) {
  predict(gap.known_s, noise);
  P_ = held(P_, gap);
  x_ = prior_ = held(x_, gap);
}

void Ieskf::begin_update() {
  const ActiveMatrix P = P_.topLeftCorner<kActiveDim, kActiveDim>() + kVarianceFloor * ActiveMatrix::Identity();
  const Eigen::LLT<ActiveMatrix> factors(P);
  sound_ = factors.info() == Eigen::Success;
  prior_information_ = factors.solve(ActiveMatrix::Identity());
}

StateVector Ieskf::expected(StateBlock at, const Eigen::Vector3d& value) const {
  const Eigen::Matrix3d variance = P_.block<3, 3>(at, at) + kVarianceFloor * Eigen::Matrix3d::Identity();
  return P_.middleCols<3>(at) * variance.llt().solve(value);
}

// min |e + J dx|^2_P + sum |r + H dx|^2: (H^T W H + J^T P^-1 J) dx = -(H^T W r + J^T P^-1 e), e = x [-] prior.
StateVector Ieskf::iterate(const NormalEquations& measured) {
  using ActiveVector = Eigen::Matrix<double, kActiveDim, 1>;
  const StateVector e = boxminus(x_, prior_);
  const ActiveMatrix J = boxminus_jacobian(e).topLeftCorner<kActiveDim, kActiveDim>();
  const ActiveMatrix JtP = J.transpose() * prior_information_;
  measured_information_ = measured.information;
  information_ = measured_information_ + JtP * J;
  const ActiveVector gradient = measured.gradient + JtP * e.head<kActiveDim>();
  const Eigen::LLT<ActiveMatrix> factors(information_);
  sound_ = sound_ && factors.info() == Eigen::Success && information_.allFinite();
  StateVector dx = StateVector::Zero();
  dx.head<kActiveDim>() = -factors.solve(gradient);
  x_ = boxplus(x_, dx);
  return dx;
}

bool Ieskf::conclude() {
  const ActiveMatrix P = information_.llt().solve(ActiveMatrix::Identity());
  if (!sound_ || !boxminus(x_, prior_).allFinite() || !P.allFinite()) {
    abandon();
    return false;
  }
  P_.setZero();
  P_.topLeftCorner<kActiveDim, kActiveDim>() = 0.5 * (P + P.transpose());
  return true;
}

Innovation Ieskf::innovation() const {
  return lxd::innovation(prior_information_, measured_information_, boxminus(x_, prior_).head<kActiveDim>());
}

}  // namespace lxd
