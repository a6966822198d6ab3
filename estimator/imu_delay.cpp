// SPDX-License-Identifier: Apache-2.0
#include "estimator/imu_delay.hpp"

#include <algorithm>
#include <cmath>

namespace lxd {
namespace {

// The clocks' models go on settling for minutes: 0.15 ms in one.
constexpr double kWalk_s_per_sqrt_s = 2e-5;
// Sensors that are farther apart than this are no rig. The IMU's readings reach back a second.
constexpr double kDelayMax_s = 0.05;

}  // namespace

// Readings that come late by d are of the rate w(t - d): too small by d dw/dt, as if the bias were wrong by as much.
void ImuDelay::predict(const StateMatrix& F, const InertialSpan& m) {
  if (!(m.span_s > 0)) return;
  StateVector wrong = StateVector::Zero();
  wrong.segment<3>(kGyroBias) = -m.rate_change_radps / m.span_s;
  wrong.segment<3>(kAccelBias) = -m.force_change_mps2 / m.span_s;
  by_delay_ = (F * (by_delay_ + wrong) - wrong).eval();
  variance_s2_ += variance_s2_ > 0 ? kWalk_s_per_sqrt_s * kWalk_s_per_sqrt_s * m.span_s : 0.0;
}

double ImuDelay::sigma_s() const { return std::sqrt(variance_s2_); }

// With V = by_delay_, c the skew's rows, H those of the state and W their weights, the rows show the delay as s = H V +
// c. Its information is s^T S^-1 s, its gradient -s^T S^-1 r, S = H P H^T + W^-1. By the matrix inversion lemma both
// are told by sums and by what the update has at hand: with L = P^-1 and r what is left after the update, -s^T S^-1
// r_prior = V^T L dx - c^T W r.
void ImuDelay::update(const UpdateRecord& u) {
  const LidarVector V = by_delay_.head<kLidarDim>();
  const LidarVector AV = u.measured_information * V, shown = AV + u.skew.coupling;
  const StateVector corrected = u.P.leftCols<kLidarDim>() * shown;
  by_delay_ -= corrected;
  if (!(variance_s2_ > 0) || !(u.skew.information > 0)) return;
  const double information =
      (V.dot(AV + 2 * u.skew.coupling) + u.skew.information - shown.dot(corrected.head<kLidarDim>())) / u.doubt;
  const double gradient = (V.dot((u.prior_information * u.correction).head<kLidarDim>()) - u.skew.gradient) / u.doubt;
  if (!(information >= 0) || !std::isfinite(gradient)) return;
  variance_s2_ /= 1 + variance_s2_ * information;
  delay_s_ = std::clamp(delay_s_ + variance_s2_ * gradient, -kDelayMax_s, kDelayMax_s);
}

}  // namespace lxd
