// SPDX-License-Identifier: Apache-2.0
#include "drivers/ros1/scan.hpp"

#include <algorithm>
#include <cmath>

namespace lxd {
namespace {

constexpr std::int64_t kLongestScan_ns = kNanosPerSecond;  // the slowest spinning LiDAR turns at 5 Hz
constexpr Duration kUnixTime = Duration::from_ns(1'000'000 * kNanosPerSecond);  // later than this: counted from 1970

}  // namespace

void push_ros1_point(Ros1Scan& scan, const Ros1Point& point) {
  if (!std::isfinite(point.x_m) || !std::isfinite(point.y_m) || !std::isfinite(point.z_m)) {
    ++scan.non_finite;
  } else if (point.x_m == 0 && point.y_m == 0 && point.z_m == 0) {
    ++scan.no_return;
  } else {
    scan.points.push_back(point);
    if (!std::isfinite(point.intensity)) scan.points.back().intensity = 0;
  }
}

Ros1Fault count_from_first(Ros1Scan& scan) {
  if (scan.points.empty()) return Ros1Fault::empty;
  const auto [first, last] = std::ranges::minmax(scan.points, {}, &Ros1Point::offset_ns);
  if (last.offset_ns - first.offset_ns > kLongestScan_ns) return Ros1Fault::bad_time;
  scan.first = Duration::from_ns(first.offset_ns);
  for (Ros1Point& point : scan.points) point.offset_ns -= scan.first.ns();
  if (!scan.header.is_stamped() && scan.first > kUnixTime) {
    scan.header.stamp = RigTime() + scan.first;
    scan.first = {};
  }
  return Ros1Fault::none;
}

}  // namespace lxd
