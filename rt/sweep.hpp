// SPDX-License-Identifier: Apache-2.0
// One LiDAR sweep: what every LiDAR driver fills and the estimator reads. Storage is lent by a SweepPool and handed
// over by index, never copied.
#pragma once

#include <cstdint>
#include <span>

#include "rt/time.hpp"

namespace lxd {

// A return in the sensor's frame at the instant it was fired (not deskewed).
struct LidarPoint {
  float x_m = 0, y_m = 0, z_m = 0;
  float intensity = 0;          // the sensor's own scale
  std::uint32_t offset_ns = 0;  // firing time minus Sweep::begin
};

struct Sweep {
  RigTime begin;  // rig time of offset 0
  RigTime end;    // rig time of the last firing: the filter's state is estimated here
  RigTime stamp;  // within [begin, end]: the time by which the source names the sweep; its pose is published here
  std::uint8_t lidar = 0;  // 0 the primary LiDAR, 1 the extra one
  std::uint32_t sequence = 0;
  std::uint32_t count = 0;        // points in use
  std::span<LidarPoint> storage;  // capacity = storage.size()

  [[nodiscard]] std::span<const LidarPoint> points() const { return storage.first(count); }
  [[nodiscard]] bool full() const { return count == storage.size(); }
  // False when full; the caller counts the drop.
  bool push(const LidarPoint& p) {
    if (full()) return false;
    storage[count++] = p;
    return true;
  }
};

}  // namespace lxd
