// SPDX-License-Identifier: Apache-2.0
// The two residuals of bidirectional PnP (paper, e_A and e_B) on the normalised image plane, whitened by what bearing
// and distance are uncertain by.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "backend/loop_measurement.hpp"
#include "backend/pnp/feature_match.hpp"
#include "backend/pnp/visual_key_frame.hpp"
#include "rt/pose.hpp"

namespace lxd {

enum class Direction : std::uint8_t {
  forward,  // set A: a historical point seen in the current image
  backward  // set B: a current point seen in the historical image
};

// One 3D-2D constraint on T_CH.
struct ProjectionConstraint {
  Direction direction = Direction::forward;
  Eigen::Vector3d point_m;    // camera frame of whom it is a landmark of
  Eigen::Vector2d seen;       // in the other's image, normalised
  double seen_sigma = 0;      // of it, either way
  double point_sigma_m = 0;   // along the point's own ray
  double across_sigma_m = 0;  // of the point across its ray
};

// Both sets of the matches; the forward one first.
std::vector<ProjectionConstraint> constraints_of(const VisualKeyFrame& historical, const VisualKeyFrame& current,
                                                 std::span<const FeatureMatch> matches);

struct ProjectionResidual {
  Eigen::Vector2d r;              // whitened
  Eigen::Matrix<double, 2, 6> J;  // d r / d [dtheta, dp] of R_CH <- R_CH Exp(dtheta), t_CH <- t_CH + dp
};

// False: the point is behind the camera. The whitening is taken at T_CH and is not differentiated.
bool project_constraint(const ProjectionConstraint& constraint, const Pose& T_CH, ProjectionResidual& out);

}  // namespace lxd
