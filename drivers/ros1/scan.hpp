// SPDX-License-Identifier: Apache-2.0
// A sweep as the messages of LiDARs have it: points, each with its time against the sweep's first.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/ros1/header.hpp"

namespace lxd {

struct Ros1Point {
  float x_m = 0, y_m = 0, z_m = 0, intensity = 0;  // sensor frame
  std::int64_t offset_ns = 0;
};

struct Ros1Scan {
  Ros1Header header;
  bool has_times = false;         // else all points have the stamp
  Duration first;                 // of the earliest point after the header's stamp; negative: before it
  std::vector<Ros1Point> points;  // in the message's order; offset_ns >= 0, the earliest has 0
  std::uint64_t no_return = 0;    // points that were left out: the origin
  std::uint64_t non_finite = 0;   // likewise: coordinates or a time that are no number
};

// A point with its offset to the header's stamp, or what it is counted as.
void push_ros1_point(Ros1Scan& scan, const Ros1Point& point);
// When all points are in: turns offsets to the stamp, of either sign, into those to the earliest point. `empty` without
// one, `bad_time` when they are spread over more than a second. A header without a stamp gets one where points have
// the time of day.
Ros1Fault count_from_first(Ros1Scan& scan);

}  // namespace lxd
