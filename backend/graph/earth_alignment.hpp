// SPDX-License-Identifier: Apache-2.0
// Where a map lies on the earth, from antenna positions in it and fixes of the same instants: yaw and offset; both have
// gravity along -z.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "backend/graph/factors.hpp"

namespace lxd {

struct AlignmentPair {
  Eigen::Vector3d map_m, enu_m;
  double sigma_m;  // of enu_m, horizontally
};

struct AlignmentFit {
  EarthAlignment alignment;  // its delay is 0
  std::vector<bool> fits;    // which pairs do
};

// None: the way is too short for the fixes' errors to tell a direction, or more than three in ten fixes disagree (a
// receiver that repeats one place, or leaps). Deterministic.
std::optional<AlignmentFit> fit_alignment(std::span<const AlignmentPair> pairs);

}  // namespace lxd
