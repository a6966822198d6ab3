// SPDX-License-Identifier: Apache-2.0
// The rigid transform between the estimate's map and truth's world. No scale: a LiDAR knows the metre.
#pragma once

#include <span>

#include "rt/pose.hpp"
#include "tools/evaluate/associate.hpp"

namespace lxd {

// T_truth_map that minimises sum |truth.p - T * estimate.p|^2 (Umeyama, TPAMI 1991, without scale). Where positions
// leave a rotation open (a straight or standing path), orientations decide it: each pose carries three more points,
// kLever_m along its axes, too near to be felt where positions do decide.
inline constexpr double kLever_m = 0.01;
Pose align_path(std::span<const PosePair> pairs, bool oriented);

// T_truth_map that makes the first poses equal. Precondition: there is a pair.
Pose align_first(std::span<const PosePair> pairs);

}  // namespace lxd
