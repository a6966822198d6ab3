// SPDX-License-Identifier: Apache-2.0
// The rigid transform between the estimate's map and truth's world. No scale: a LiDAR knows the metre.
#pragma once

#include <span>

#include "rt/pose.hpp"
#include "tools/evaluate/associate.hpp"

namespace lxd {

// T_truth_map that minimises sum |truth.p - T * estimate.p|^2 (Umeyama, TPAMI 1991, without scale). Where positions
// leave a rotation open (a straight or standing path), orientations decide it: each pose carries three more points,
// lever_m along its axes. Without orientations: 0.
inline constexpr double kPathLever_m = 0.01;  // too near to be felt where positions do decide
// A mesh lies farther out than the path is wide: about a straight path a degree of roll that no position feels is
// decimetres at its walls.
inline constexpr double kMeshLever_m = 1.0;
Pose align_path(std::span<const PosePair> pairs, double lever_m);

// T_truth_map that makes the first poses equal. Precondition: there is a pair.
Pose align_first(std::span<const PosePair> pairs);

}  // namespace lxd
