// SPDX-License-Identifier: Apache-2.0
// The residuals of the factor graph with their Jacobians (paper, "Global Factor Graph Formulation"), each whitened, so
// that its square is its cost. Jacobians are by the tangent of rt/so3.hpp: [rotation (right), position]. No solver
// here.
#pragma once

#include <cmath>

#include <Eigen/Core>

#include "backend/graph/relative_motion.hpp"

namespace lxd {

// r_odom, r_submesh and r_loop of the paper: T_a_b was measured.
struct RelativeFactor {
  Pose T_a_b;
  Matrix6d sqrt_information;

  // Jacobians may be nullptr.
  Vector6d evaluate(const Pose& T_map_a, const Pose& T_map_b, Matrix6d* by_a, Matrix6d* by_b) const;
};

// Where the map lies on the earth: p_enu = Rz(yaw) p_map + offset. Both have gravity along -z. `delay` is how much
// older a fix is than its stamp: what a receiver takes to compute and to send it.
struct EarthAlignment {
  double yaw_rad = 0;
  Eigen::Vector3d offset_m = Eigen::Vector3d::Zero();
  double delay_s = 0;

  [[nodiscard]] Eigen::Vector3d to_enu(const Eigen::Vector3d& p_map_m) const;
  // Where a fix of this stamp says that the antenna is, which moves at `velocity_mps`: both in the body.
  [[nodiscard]] Eigen::Vector3d antenna_enu_m(const Pose& T_map_body, const Eigen::Vector3d& antenna_m,
                                              const Eigen::Vector3d& velocity_mps) const;
};
inline constexpr int kAlignmentSize = 5;  // yaw, offset, delay
using AlignmentVector = Eigen::Matrix<double, kAlignmentSize, 1>;

// The paper's r_gnss has neither lever arm nor alignment; design 6.6 asks for both.
struct GnssFactor {
  Eigen::Vector3d antenna_body_m;        // at the stamp of the fix, in the key frame's body
  Eigen::Vector3d antenna_velocity_mps;  // of that, in the same axes
  Eigen::Vector3d enu_m;
  Eigen::Matrix3d lasting_root;      // L: the fix errs by L b, with a b of unit variance that lasts, and by
  Eigen::Matrix3d sqrt_information;  // of this, which does not

  // Whitened, its lasting part `b` taken out.
  Eigen::Vector3d evaluate(const Pose& T_map_body, const EarthAlignment& alignment, const Eigen::Vector3d& b,
                           Eigen::Matrix<double, 3, 6>* by_pose,
                           Eigen::Matrix<double, 3, kAlignmentSize>* by_alignment) const;
  [[nodiscard]] Eigen::Matrix3d by_lasting() const { return sqrt_information * lasting_root; }
};

// What lasts of the fixes' errors, at two instants one after the other: a Gauss-Markov process of unit variance.
struct LastingFactor {
  double keep;  // exp(-(time between) / (time constant)), below 1

  [[nodiscard]] double by_before() const { return -keep * by_now(); }
  [[nodiscard]] double by_now() const { return 1 / std::sqrt(1 - keep * keep); }
};

// An IMU knows what is up: the map must not tilt against it.
struct TiltFactor {
  Eigen::Vector3d up_body;  // unit
  double sigma_rad;

  Eigen::Vector3d evaluate(const Pose& T_map_body, Eigen::Matrix<double, 3, 6>* by_pose) const;
};

// Holds the first pose where it is: the map begins with the world. Loose where other factors shall decide.
struct AnchorFactor {
  Pose T_map_body;
  Vector6d sigmas;  // along the tangent: rotation in the map's axes, position

  Vector6d evaluate(const Pose& T, Matrix6d* by_pose) const;
};

}  // namespace lxd
