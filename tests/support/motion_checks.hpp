// SPDX-License-Identifier: Apache-2.0
// Checks of a simulated motion that do not use its formulas: difference quotients, and dead reckoning from its samples.
#pragma once

#include <cmath>

#include "rt/so3.hpp"
#include "tools/simulator/motion/trajectory.hpp"

namespace lxd::test {

// Central differences of the poses: error about 1e-7 of the fourth derivative's scale at this step.
struct Differences {
  Differences(const sim::Trajectory& motion, double t_s, double step_s = 1e-4) {
    const Pose before = motion.pose(t_s - step_s);
    const Pose after = motion.pose(t_s + step_s);
    v = (after.p - before.p) / (2 * step_s);
    omega = Log(before.R.transpose() * after.R) / (2 * step_s);
    const sim::MotionState a0 = motion.at(t_s - step_s), a1 = motion.at(t_s + step_s);
    a = (a1.v_world_mps - a0.v_world_mps) / (2 * step_s);
    alpha = (a1.omega_body_radps - a0.omega_body_radps) / (2 * step_s);
  }
  Eigen::Vector3d v, omega, a, alpha;
};

struct ReckoningError {
  double position_m;
  double angle_rad;
};

// What an IMU at the body measures without noise; gravity, which cancels exactly, is left out.
struct FeltMotion {
  FeltMotion(const sim::Trajectory& motion, double t_s) {
    const sim::MotionState state = motion.at(t_s);
    omega = state.omega_body_radps;
    force = state.T_world_body.R.transpose() * state.a_world_mps2;
  }
  Eigen::Vector3d omega, force;
};

// Dead reckoning from the true start with samples every step_s, two steps at a time: rates and the world's acceleration
// are parabolas through three samples (Simpson). The cross products are the coning term (Bortz, "A new mathematical
// formulation for strapdown inertial navigation", 1971). Trapezoids would not do: started at a jerk of 100 m/s^3 they
// are 2 mm off after 10 s at 200 Hz, by their own formula.
inline ReckoningError reckon(const sim::Trajectory& motion, double begin_s, double duration_s, double step_s) {
  const sim::MotionState start = motion.at(begin_s);
  Pose T = start.T_world_body;
  Eigen::Vector3d v = start.v_world_mps;
  const auto pairs = std::lround(duration_s / step_s / 2);
  const double cone = step_s * step_s / 12;
  FeltMotion s0(motion, begin_s);
  for (long i = 0; i < pairs; ++i) {
    const FeltMotion s1(motion, begin_s + static_cast<double>(2 * i + 1) * step_s);
    const FeltMotion s2(motion, begin_s + static_cast<double>(2 * i + 2) * step_s);
    const Eigen::Vector3d half = step_s / 12 * (5 * s0.omega + 8 * s1.omega - s2.omega);
    const Eigen::Vector3d whole = step_s / 3 * (s0.omega + 4 * s1.omega + s2.omega);
    const Eigen::Matrix3d R1 = T.R * Exp(half + cone * s0.omega.cross(s1.omega));
    const Eigen::Matrix3d R2 = T.R * Exp(whole + 4 * cone * s0.omega.cross(s2.omega));
    const Eigen::Vector3d a0 = T.R * s0.force, a1 = R1 * s1.force, a2 = R2 * s2.force;
    T = {R2, T.p + 2 * step_s * v + step_s * step_s / 3 * (2 * a0 + 4 * a1)};
    v += step_s / 3 * (a0 + 4 * a1 + a2);
    s0 = s2;
  }
  const Pose end = motion.pose(begin_s + static_cast<double>(2 * pairs) * step_s);
  return {(T.p - end.p).norm(), Log(T.R.transpose() * end.R).norm()};
}

}  // namespace lxd::test
