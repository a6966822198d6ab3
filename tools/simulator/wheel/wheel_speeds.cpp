// SPDX-License-Identifier: Apache-2.0
// See wheel_speeds.hpp.
#include "tools/simulator/wheel/wheel_speeds.hpp"

#include <array>
#include <cmath>

namespace lxd::sim {

WheelMotion::WheelMotion(const Context& context, const WheelConfig& config) : context_(context), config_(config) {
  draw_slips();
}

// The speed of the wheel frame's origin, in the wheel frame, and from it that of each wheel's centre along its way.
WheelSpeeds WheelMotion::at(double t_s) const {
  const MotionState body = context_.motion.at(t_s);
  const Pose& T = config_.T_body_sensor;
  const Eigen::Vector3d omega = T.R.transpose() * body.omega_body_radps;
  const Eigen::Vector3d v =
      T.R.transpose() * (body.T_world_body.R.transpose() * body.v_world_mps + body.omega_body_radps.cross(T.p));
  const double swing_mps = omega.z() * config_.track_m / 2;
  const double front_side_mps = v.y() + omega.z() * config_.wheelbase_m;
  const auto front = [&](double forward_mps) {
    return std::copysign(std::hypot(forward_mps, front_side_mps), forward_mps);
  };
  const double left = (1 + config_.scale_error) * slip_factor(t_s, &Slip::left);
  const double right = (1 + config_.scale_error) * slip_factor(t_s, &Slip::right);
  return {left * (v.x() - swing_mps), right * (v.x() + swing_mps), left * front(v.x() - swing_mps),
          right * front(v.x() + swing_mps), omega.z()};
}

WheelMotion::Ways WheelMotion::ways(double begin_s, double end_s) const {
  constexpr std::array kNodes{-0.7745966692414834, 0.0, 0.7745966692414834};
  constexpr std::array kWeights{5.0 / 9, 8.0 / 9, 5.0 / 9};
  const double half_s = (end_s - begin_s) / 2, middle_s = (begin_s + end_s) / 2;
  Ways ways;
  for (std::size_t i = 0; i < kNodes.size(); ++i) {
    const WheelSpeeds speeds = at(middle_s + half_s * kNodes[i]);
    ways.left_m += half_s * kWeights[i] * speeds.left_mps;
    ways.right_m += half_s * kWeights[i] * speeds.right_mps;
  }
  return ways;
}

// Poisson: the times between slips are exponential. One side or both.
void WheelMotion::draw_slips() {
  if (config_.slip_per_minute <= 0) return;
  constexpr double kMinute_s = 60;
  Random random(context_.seed, "wheel_slip");
  double t_s = 0;
  for (;;) {
    t_s -= kMinute_s / config_.slip_per_minute * std::log(1 - random.uniform());
    if (t_s >= context_.duration_s) return;
    const std::uint64_t sides = random.bits() % 3;
    slips_.push_back({t_s, t_s + config_.slip_s, sides != 1, sides != 0});
    t_s += config_.slip_s;
  }
}

double WheelMotion::slip_factor(double t_s, bool Slip::*side) const {
  double factor = 1;
  if (const Fault* const fault = context_.faults.active("wheel_slip", t_s)) factor += fault->value;
  for (const Slip& slip : slips_)
    if (t_s >= slip.begin_s && t_s < slip.end_s && slip.*side) factor += config_.slip_part;
  return factor;
}

double WheelMotion::slip_s() const {
  double sum_s = 0;
  for (const Slip& slip : slips_) sum_s += std::min(slip.end_s, context_.duration_s) - slip.begin_s;
  return sum_s;
}

}  // namespace lxd::sim
