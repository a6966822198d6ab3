// SPDX-License-Identifier: Apache-2.0
// Which sensors take part in a run, as `--sensors` writes it: the first L is the primary LiDAR, a second L the extra
// one, then camera, IMU, wheel and GNSS.
#pragma once

#include <string>
#include <string_view>

#include "rt/result.hpp"

namespace lxd {

struct SensorSet {
  bool extra_lidar = false;
  bool camera = false;
  bool imu = false;
  bool wheel = false;
  bool gnss = false;

  bool operator==(const SensorSet&) const = default;
};

// "L", "LI", "LLCIWG"...: L or LL first, then any of C I W G once each, in any order.
Result<SensorSet> parse_sensor_set(std::string_view text);

// In the order L L C I W G.
std::string text_of(const SensorSet& sensors);

}  // namespace lxd
