// SPDX-License-Identifier: Apache-2.0
#include "estimator/wheel_alignment.hpp"

#include <algorithm>

#include <Eigen/LU>

#include "estimator/normal_equations.hpp"
#include "rt/so3.hpp"
#include "rt/square.hpp"

namespace lxd {
namespace {

constexpr double kWheelDelayWalk_s_per_sqrt_s = 2e-5;  // as the other clocks': 0.15 ms in a minute
constexpr double kWheelDelayMax_s = 0.05;              // sensors that are farther apart than this are no rig
constexpr double kWayScaleSigma = 0.02;                // tyres' radii
constexpr double kTurnScaleSigma = 0.2;                // wheels that are steered by their difference slip in turns
constexpr double kPoseSigma_m = 5e-4, kPoseSigma_rad = 2e-4;  // of a pose that the LiDAR holds, to its neighbours
constexpr double kSpeedChange_mps = 0.02, kRateChange_radps = 0.02;  // less is the wheels' own noise
constexpr double kWaysAlike = 2;                                     // so many neighbouring ones err alike
constexpr double kMisfitShare = 0.05;                                // of one of them in the running mean
constexpr double kUnexplainedGate = 10.8;                            // chi-square, one degree of freedom, 0.999
constexpr double kKernel_sigmas = 3;
constexpr double kBeyondClaim = 4;  // sigmas that a rig file may be off by
constexpr double kStraight_rad = 1e-4;

}  // namespace

DrivenArc driven_arc(const Pose& then, const Pose& now) {
  const Eigen::Vector3d turn = Log(then.R.transpose() * now.R);
  const Eigen::Vector3d ahead = then.R * Exp(turn / 2).col(0);
  const double half = turn.z() / 2, chord_m = ahead.dot(now.p - then.p);
  return {std::abs(half) < kStraight_rad ? chord_m : chord_m * half / std::sin(half), turn.z()};
}

WheelAlignment::WheelAlignment(double delay_s, double delay_sigma_s, double speed_sigma_mps,
                               double yaw_rate_sigma_radps)
    : delay_s_(delay_s), speed_variance_(square(speed_sigma_mps)), yaw_rate_variance_(square(yaw_rate_sigma_radps)) {
  if (!(delay_sigma_s > 0)) return;
  P_.diagonal() << square(delay_sigma_s), square(kWayScaleSigma), square(kTurnScaleSigma);
}

// With the delay wrong by d (too small), the wheels' way is that from d before: seen = rolled + change * d, and the
// scale's share.
void WheelAlignment::compare(const DrivenArc& seen, const WheelWay& rolled, double over_s) noexcept {
  if (known() || rolled.readings == 0) return;
  P_(0, 0) += square(kWheelDelayWalk_s_per_sqrt_s) * std::max(0.0, over_s);
  const double weight_s2 = rolled.span_s * rolled.span_s / rolled.readings;
  const auto worth = [](double change, double least) { return std::abs(change) > least ? change : 0.0; };
  learn(seen.way_m - rolled.way_m * (1 + scale_[0]),
        {worth(rolled.speed_change_mps, kSpeedChange_mps), rolled.way_m, 0},
        speed_variance_ * weight_s2 + 2 * square(kPoseSigma_m), way_misfit_);
  learn(seen.turn_rad - rolled.turn_rad * (1 + scale_[1]),
        {worth(rolled.rate_change_radps, kRateChange_radps), 0, rolled.turn_rad},
        yaw_rate_variance_ * weight_s2 + 2 * square(kPoseSigma_rad), turn_misfit_);
}

// lacking = by [delay, scale] + noise. What not even a rig file that is wrong explains is slip: by its running mean all
// are believed less.
void WheelAlignment::learn(double lacking, const Eigen::Vector3d& by, double variance, double& misfit) noexcept {
  const Eigen::Vector3d coupling = P_ * by;
  const double doubt = by.dot(coupling);
  if (!std::isfinite(lacking) || !(doubt > 0)) return;
  const double rest = square(lacking) / (misfit * variance + square(kBeyondClaim) * doubt);
  const double explained = square(lacking) / (misfit * variance + doubt) - rest;
  const double weight = geman_mcclure(explained, square(kKernel_sigmas)) / (kWaysAlike * misfit);
  misfit = std::max(1.0, misfit * (1 + kMisfitShare * (std::min(rest, kUnexplainedGate) - 1)));
  if (!(rest < kUnexplainedGate)) return;
  const Eigen::Vector3d gain = coupling / (doubt + variance / weight);
  delay_s_ = std::clamp(delay_s_ + gain[0] * lacking, -kWheelDelayMax_s, kWheelDelayMax_s);
  scale_ += gain.tail<2>() * lacking;
  P_ -= gain * coupling.transpose();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
}

}  // namespace lxd
