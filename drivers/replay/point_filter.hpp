// SPDX-License-Identifier: Apache-2.0
// Which points of a scan file are points at all; what is not, is counted and left out.
#pragma once

#include <cmath>
#include <cstdint>

#include "drivers/replay/rejections.hpp"

namespace lxd {

struct PointCounts {
  std::uint64_t non_finite = 0, no_return = 0, bad_time = 0, above_capacity = 0;

  void report(Rejections& rejected) const {
    count_rejected(rejected, "non_finite_point", non_finite);
    count_rejected(rejected, "no_return", no_return);
    count_rejected(rejected, "bad_point_time", bad_time);
    count_rejected(rejected, "above_capacity", above_capacity);
  }
};

// point: x y z (m) intensity. Formats write a missing return as the origin.
inline bool sound_point(const float* point, PointCounts& counts) {
  // The sum is finite exactly when all are: inf - inf is NaN. Differences of huge finite values overflow to inf, and no
  // LiDAR sees 1e38 m.
  if (!std::isfinite(point[0] + point[1] + point[2] + point[3])) {
    ++counts.non_finite;
    return false;
  }
  if (point[0] == 0 && point[1] == 0 && point[2] == 0) {
    ++counts.no_return;
    return false;
  }
  return true;
}

}  // namespace lxd
