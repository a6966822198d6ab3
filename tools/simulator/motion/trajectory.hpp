// SPDX-License-Identifier: Apache-2.0
// The exact motion of the rig's reference frame (its body): a smooth curve on SE(3) whose pose, velocity, acceleration
// and rates are derivatives of each other, so that every sensor sees the same truth.
#pragma once

#include <vector>

#include <Eigen/Geometry>

#include "rt/pose.hpp"

namespace lxd::sim {

struct MotionState {
  Pose T_world_body;
  Eigen::Vector3d v_world_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d a_world_mps2 = Eigen::Vector3d::Zero();  // without gravity
  Eigen::Vector3d omega_body_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d alpha_body_radps2 = Eigen::Vector3d::Zero();
};

// Cumulative uniform B-splines. Control points are given; fitting them to a path is path_fit.hpp's.
class Trajectory {
 public:
  // Knots `step_s` apart; control point i acts around first_knot_s + i * step_s. Positions and rotations: as many each.
  Trajectory(double first_knot_s, double step_s, std::vector<Eigen::Vector3d> positions_m,
             std::vector<Eigen::Quaterniond> rotations);

  // t_s since the recording's start, within [begin_s(), end_s()]; outside it the ends are held.
  [[nodiscard]] MotionState at(double t_s) const;
  [[nodiscard]] double begin_s() const;
  [[nodiscard]] double end_s() const;

 private:
  double first_knot_s_;
  double step_s_;
  std::vector<Eigen::Vector3d> positions_m_;
  std::vector<Eigen::Quaterniond> rotations_;
};

}  // namespace lxd::sim
