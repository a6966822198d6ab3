// SPDX-License-Identifier: Apache-2.0
// By how much the wheels' readings are stamped later than the LiDAR's returns of the same instant. The way and the turn
// between two poses that the LiDAR holds are held against what the wheels rolled meanwhile: when they are late it is
// what they rolled a little earlier. A carrier that goes on steadily tells nothing. README.md, "The wheels' delay".
// Real-time thread.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "estimator/wheel_history.hpp"
#include "rt/pose.hpp"

namespace lxd {

struct DrivenArc {
  double way_m, turn_rad;
};
// From one pose of the wheel frame to another: of the circle on which a wheeled carrier goes, in the plane of its
// wheels.
DrivenArc driven_arc(const Pose& T_world_then, const Pose& T_world_now);

class WheelAlignment {
 public:
  WheelAlignment() = default;  // known exactly: none
  // At first: s, and how sure that is (0: exactly); of one reading.
  WheelAlignment(double delay_s, double delay_sigma_s, double speed_sigma_mps, double yaw_rate_sigma_radps);

  [[nodiscard]] double delay_s() const { return delay_s_; }  // an instant's reading is stamped so much later
  [[nodiscard]] double delay_sigma_s() const { return std::sqrt(P_(0, 0)); }
  [[nodiscard]] Duration delay() const { return Duration::from_seconds(delay_s_); }
  [[nodiscard]] bool known() const { return !(P_(0, 0) > 0); }  // exactly, by the rig file

  // rolled: by the wheels, at their stamps less delay(). over_s: since the last comparison.
  void compare(const DrivenArc& seen, const WheelWay& rolled, double over_s) noexcept;

 private:
  void learn(double lacking, const Eigen::Vector3d& by, double variance, double& misfit) noexcept;

  double delay_s_ = 0, speed_variance_ = 0, yaw_rate_variance_ = 0;
  Eigen::Vector2d scale_ = Eigen::Vector2d::Zero();  // true way and turn over those rolled, less 1
  Eigen::Matrix3d P_ = Eigen::Matrix3d::Zero();      // of [delay, scale]; zero: known exactly
  // Running means of squared ratios of what nothing explains; 1: as large as it should be.
  double way_misfit_ = 1, turn_misfit_ = 1;
};

}  // namespace lxd
