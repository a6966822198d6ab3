// SPDX-License-Identifier: Apache-2.0
// What a LiDAR sees that stands in the middle of a room: the smallest sweep that a map and a path can be made of.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace lxd::test {

inline constexpr int kRoomColumns = 512, kRoomBeams = 16;

// x y z (m) and intensity: four walls 4 m away, the floor 1.2 m below, and a pillar, so that no turn looks like
// another.
inline std::vector<std::array<float, 4>> room_scan() {
  constexpr float kHalf_m = 4, kFloor_m = -1.2F, kPillar_m = 2.5F, kPillarHalf_rad = 0.15F;
  std::vector<std::array<float, 4>> points;
  for (int c = 0; c < kRoomColumns; ++c) {
    const float azimuth = 2 * std::numbers::pi_v<float> * (static_cast<float>(c) + 0.5F) / kRoomColumns;
    float reach = kHalf_m / std::max(std::abs(std::cos(azimuth)), std::abs(std::sin(azimuth)));
    if (std::abs(azimuth - 1) < kPillarHalf_rad) reach = kPillar_m;
    for (int b = 0; b < kRoomBeams; ++b) {
      const float slope = -0.4F + 0.05F * static_cast<float>(b);
      const float across = slope < 0 ? std::min(reach, kFloor_m / slope) : reach;
      points.push_back({across * std::cos(azimuth), across * std::sin(azimuth), across * slope, 1});
    }
  }
  return points;
}

}  // namespace lxd::test
