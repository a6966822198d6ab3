// SPDX-License-Identifier: Apache-2.0
// A pose with its time: the element of every path that is stored, written, drawn or evaluated.
#pragma once

#include <algorithm>
#include <cstddef>
#include <span>

#include "rt/pose.hpp"
#include "rt/time.hpp"

namespace lxd {

struct StampedPose {
  RigTime stamp;
  Pose T;  // T_map_reference, m
};

// Which of a path's poses has the stamp nearest to a time. The path is in order of time, and has some.
inline std::size_t nearest_pose(std::span<const StampedPose> path, double time_s) {
  const auto seconds = [](const StampedPose& pose) { return pose.stamp.seconds(); };
  const auto after = static_cast<std::size_t>(std::ranges::lower_bound(path, time_s, {}, seconds) - path.begin());
  if (after == path.size()) return after - 1;
  if (after == 0) return 0;
  return seconds(path[after]) - time_s < time_s - seconds(path[after - 1]) ? after : after - 1;
}

}  // namespace lxd
