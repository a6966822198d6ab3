// SPDX-License-Identifier: Apache-2.0
#include "estimator/pose_predictor.hpp"

namespace lxd {
namespace {

constexpr Duration kGapMax = Duration::from_ns(50'000'000);  // between readings; at 2 m/s^2 it hides 3 mm

template <std::size_t N, typename M>
std::array<double, N> words_of(const M& matrix) {
  std::array<double, N> words;
  Eigen::Map<M>(words.data()) = matrix;
  return words;
}

Eigen::Vector3d vector_of(const std::array<double, 3>& words) {
  return Eigen::Map<const Eigen::Vector3d>(words.data());
}

}  // namespace

MotionAnchor MotionAnchor::of(RigTime t, const State& x, bool inertial, bool tracked) noexcept {
  return {t,
          words_of<9>(x.R),
          words_of<3>(x.p),
          words_of<3>(x.v),
          words_of<3>(x.b_g),
          words_of<3>(x.b_a),
          words_of<3>(x.g),
          inertial,
          tracked,
          {}};
}

State MotionAnchor::state() const noexcept {
  return {Eigen::Map<const Eigen::Matrix3d>(R.data()),
          vector_of(p),
          vector_of(v),
          vector_of(b_g),
          vector_of(b_a),
          vector_of(g)};
}

void PosePredictor::take(const MotionAnchor& anchor) noexcept {
  if (!anchor.inertial) return anchor_.reset();
  anchor_ = anchor;
  history_.set_delay(anchor.imu_delay);
  x_ = anchor.state();
  t_ = anchor.t;
}

std::optional<PredictedState> PosePredictor::add(const InertialReading& reading) noexcept {
  history_.add(reading);
  if (!anchor_ || history_.size() == 0 || history_.newest().t != reading.t) return std::nullopt;
  const RigTime t = reading.t - anchor_->imu_delay;
  const Duration reach = t - anchor_->t;
  if (t < t_ || reach > kReachMax || !carry_to(t)) return std::nullopt;
  return PredictedState{t, x_, reach, anchor_->tracked, reading.rate_radps - x_.b_g};
}

bool PosePredictor::carry_to(RigTime t) noexcept {
  if (!history_.covers(t_, t, kGapMax)) return false;
  for (const InertialSpan& span : history_.spans(t_, t)) x_ = propagate(x_, span);
  t_ = t;
  return true;
}

}  // namespace lxd
