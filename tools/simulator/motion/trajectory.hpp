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

// Cumulative uniform B-splines of order 6 (quintic: four times continuously differentiable) on R^3 and SO(3). Control
// points are given; fitting them to a path is path_fit.hpp's. Formulas: Sommer, Usenko, Schubert, Demmel, Cremers,
// "Efficient derivative computation for cumulative B-splines on Lie groups", CVPR 2020.
class Trajectory {
 public:
  static constexpr int kOrder = 6;
  static constexpr int kBefore = 2;  // control points that act at a knot, before it; one more after it
  static constexpr int kAfter = 3;

  // Knots `step_s` apart; control point i acts around first_knot_s + i * step_s. Positions and rotations: as many each.
  // Fewer than kOrder: the last is repeated. The angle between neighbours is below pi.
  Trajectory(double first_knot_s, double step_s, const std::vector<Eigen::Vector3d>& positions_m,
             const std::vector<Eigen::Quaterniond>& rotations);

  // t_s since the recording's start, within [begin_s(), end_s()]; outside it the ends are held, at rest.
  [[nodiscard]] MotionState at(double t_s) const;
  [[nodiscard]] Pose pose(double t_s) const;  // the same pose in half the time
  [[nodiscard]] double begin_s() const { return first_knot_s_ + kBefore * step_s_; }
  [[nodiscard]] double end_s() const;
  [[nodiscard]] double step_s() const { return step_s_; }

 private:
  // A control point and the way to the next.
  struct Control {
    Eigen::Vector3d p;
    Eigen::Vector3d dp;
    Eigen::Vector3d dR;  // Log(R^T R_next)
    Eigen::Quaterniond R;
  };
  struct Place {
    const Control* first;  // of the kOrder that act
    double u;              // since the knot, 0 .. 1
  };
  [[nodiscard]] Place place_of(double t_s) const;

  double first_knot_s_;
  double step_s_;
  std::vector<Control> controls_;
};

}  // namespace lxd::sim
