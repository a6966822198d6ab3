// SPDX-License-Identifier: Apache-2.0
// The joint refinement of bidirectional PnP over both sets' inliers (paper, T_CH^*), robust, by Ceres.
#pragma once

#include <optional>
#include <span>

#include "backend/loop_measurement.hpp"
#include "backend/pnp/projection_residual.hpp"

namespace lxd {

// The pose moves to the optimum. None: no solution, or directions that the constraints do not hold at all; else the
// information of [rotation (right), position] there.
std::optional<Matrix6d> refine_pose(std::span<const ProjectionConstraint> constraints, Pose& T_CH);

}  // namespace lxd
