// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/trajectory.hpp"

#include <algorithm>
#include <cmath>

#include "rt/so3.hpp"
#include "tools/simulator/motion/spline_basis.hpp"

namespace lxd::sim {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

static_assert(Trajectory::kOrder == kSplineOrder);
static_assert(Trajectory::kBefore + 1 + Trajectory::kAfter == kSplineOrder);

// The quaternion of Exp(theta).
Quaterniond exponential(const Vector3d& theta) {
  const double half = 0.5 * theta.norm();
  const double k = 0.5 * so3_detail::sinc(half);
  return {std::cos(half), k * theta.x(), k * theta.y(), k * theta.z()};
}

Vector3d logarithm(const Quaterniond& q) {
  const double n = q.vec().norm();
  const double sign = q.w() < 0 ? -1.0 : 1.0;
  if (n == 0.0) return Vector3d::Zero();
  return (sign * 2.0 * std::atan2(n, sign * q.w()) / n) * q.vec();
}

template <typename T>
const T& held(const std::vector<T>& values, std::size_t i) {
  return values[std::min(i, values.size() - 1)];
}

}  // namespace

Trajectory::Trajectory(double first_knot_s, double step_s, const std::vector<Vector3d>& positions_m,
                       const std::vector<Quaterniond>& rotations)
    : first_knot_s_(first_knot_s), step_s_(step_s) {
  controls_.resize(std::max<std::size_t>(positions_m.size(), kOrder),
                   {Vector3d::Zero(), Vector3d::Zero(), Vector3d::Zero(), Quaterniond::Identity()});
  if (positions_m.empty()) return;
  for (std::size_t i = 0; i < controls_.size(); ++i) {
    Control& control = controls_[i];
    control.p = held(positions_m, i);
    control.dp = held(positions_m, i + 1) - control.p;
    control.R = held(rotations, i).normalized();
    control.dR = logarithm(control.R.conjugate() * held(rotations, i + 1).normalized());
  }
}

double Trajectory::end_s() const { return first_knot_s_ + static_cast<double>(controls_.size() - kAfter) * step_s_; }

Trajectory::Place Trajectory::place_of(double t_s) const {
  const auto last = static_cast<double>(controls_.size() - kOrder);
  const double since = std::clamp((t_s - begin_s()) / step_s_, 0.0, last + 1);
  const double segment = std::min(std::floor(since), last);
  return {controls_.data() + static_cast<std::ptrdiff_t>(segment), since - segment};
}

Pose Trajectory::pose(double t_s) const {
  const Place place = place_of(t_s);
  const SplineWeights w = cumulative_weights(place.u);
  Vector3d p = place.first->p;
  Quaterniond R = place.first->R;
  for (std::size_t j = 1; j < kSplineOrder; ++j) {
    const Control& from = place.first[j - 1];
    p += w[j] * from.dp;
    R = R * exponential(w[j] * from.dR);
  }
  return {R.toRotationMatrix(), p};
}

MotionState Trajectory::at(double t_s) const {
  MotionState state;
  if (t_s < begin_s() || t_s > end_s()) {
    state.T_world_body = pose(t_s);
    return state;
  }
  const Place place = place_of(t_s);
  const SplineWeights w = cumulative_weights(place.u);
  const SplineWeights w1 = cumulative_weights(place.u, 1);  // per step, and per step squared: scaled at the end
  const SplineWeights w2 = cumulative_weights(place.u, 2);
  Vector3d p = place.first->p;
  Vector3d v = Vector3d::Zero(), a = Vector3d::Zero(), omega = Vector3d::Zero(), alpha = Vector3d::Zero();
  Quaterniond R = place.first->R;
  for (std::size_t j = 1; j < kSplineOrder; ++j) {
    const Control& from = place.first[j - 1];
    p += w[j] * from.dp;
    v += w1[j] * from.dp;
    a += w2[j] * from.dp;
    const Quaterniond turn = exponential(w[j] * from.dR);
    R = R * turn;
    omega = turn.conjugate() * omega + w1[j] * from.dR;
    alpha = turn.conjugate() * alpha + w1[j] * omega.cross(from.dR) + w2[j] * from.dR;
  }
  const double per_s = 1 / step_s_;
  state.T_world_body = {R.toRotationMatrix(), p};
  state.v_world_mps = per_s * v;
  state.a_world_mps2 = per_s * per_s * a;
  state.omega_body_radps = per_s * omega;
  state.alpha_body_radps2 = per_s * per_s * alpha;
  return state;
}

}  // namespace lxd::sim
