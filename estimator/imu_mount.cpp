// SPDX-License-Identifier: Apache-2.0
#include "estimator/imu_mount.hpp"

#include <Eigen/LU>

namespace lxd {
namespace {

constexpr double kImuMountWalk_rad_per_sqrt_s = 2e-5;  // warmth and load: 0.01 degrees in a minute
constexpr double kImuTurnedMax_rad = 0.17;             // ten degrees: beyond, sweeps were never deskewed
// Sweeps err alike about what a mount looks like, since they share the map, for longer than about a delay: so many
// times.
constexpr double kMapAlike = 3;

}  // namespace

// Readings that are turned too little by e are wrong by w x e, f x e, as biases are.
void ImuMount::predict(const StateMatrix& F, const InertialSpan& m) {
  if (known() || !(m.span_s > 0)) return;
  ByTurn wrong = ByTurn::Zero();
  wrong.middleRows<3>(kGyroBias) = hat(m.rate_radps);
  wrong.middleRows<3>(kAccelBias) = hat(m.force_mps2);
  by_turn_ = (F * (by_turn_ + wrong) - wrong).eval();
  rate_sum_ += m.span_s * m.rate_radps;
  span_s_ += m.span_s;
  P_.diagonal().array() += kImuMountWalk_rad_per_sqrt_s * kImuMountWalk_rad_per_sqrt_s * m.span_s;
}

// As ImuDelay::update(). The skew is told by readings that are wrong by the mean w x e of the sweep: rows show the
// mount as H (V + u), u the bias that this looks like; at rest of the iterations H^T W r = -L dx.
StateVector ImuMount::update(const UpdateRecord& u, bool telling) {
  if (known()) return StateVector::Zero();
  Eigen::Matrix<double, kLidarDim, 3> V = by_turn_.topRows<kLidarDim>();
  if (span_s_ > 0) V.middleRows<3>(kGyroBias) += hat(rate_sum_ / span_s_);
  rate_sum_.setZero();
  span_s_ = 0;
  const Eigen::Matrix<double, kLidarDim, 3> AV = u.measured_information * V;
  const ByTurn corrected = u.P.leftCols<kLidarDim>() * AV;
  by_turn_ -= corrected;
  if (!telling) return StateVector::Zero();
  const double doubt = kMapAlike * u.doubt;
  const Eigen::Matrix3d information = (V.transpose() * AV - AV.transpose() * corrected.topRows<kLidarDim>()) / doubt;
  const Eigen::Vector3d gradient = V.transpose() * (u.prior_information * u.correction).head<kLidarDim>() / doubt;
  const Eigen::Matrix3d P = (Eigen::Matrix3d::Identity() + P_ * information).inverse() * P_;
  const Eigen::Vector3d turn = P * gradient;
  const Eigen::Matrix3d R = orthonormalized(Exp(turn) * R_body_imu_);
  if (!P.allFinite() || !(Log(R).norm() < kImuTurnedMax_rad)) return StateVector::Zero();
  P_ = 0.5 * (P + P.transpose());
  R_body_imu_ = R;
  return by_turn_ * turn;
}

}  // namespace lxd
