// SPDX-License-Identifier: Apache-2.0
// Which truth belongs to which estimate: truth is interpolated at the estimate's own stamps, never the other way, so
// that no estimate is smoothed by the evaluation.
#pragma once

#include <cstddef>
#include <vector>

#include "backend/trajectory.hpp"
#include "tools/evaluate/tum_file.hpp"

namespace lxd {

struct PosePair {
  RigTime stamp;
  Pose estimate;  // T_map_reference
  Pose truth;     // T_truth_reference, before alignment
};

struct Association {
  std::vector<PosePair> pairs;  // in order of time
  std::size_t unmatched = 0;    // estimates outside of truth's time, or within a gap of it
};

// Positions linearly, orientations by SLERP, between the two truths around each estimate, unless these are further
// apart than gap_max. Stamps within kEndTolerance beyond truth's ends take the end's pose: files are rounded to 0.1 ms.
inline constexpr Duration kEndTolerance = Duration::from_ns(100'000);
Association associate(const Trajectory& estimate, const Trajectory& truth, Duration gap_max);

}  // namespace lxd
