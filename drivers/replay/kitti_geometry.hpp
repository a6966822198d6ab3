// SPDX-License-Identifier: Apache-2.0
// Two facts about KITTI's Velodyne HDL-64E that its files do not carry: when a point was fired, and that every
// elevation is read a little too low. Derivations in the README.
#pragma once

#include <cmath>
#include <numbers>

#include "drivers/replay/fast_atan2.hpp"

namespace lxd {

// The part of the turn that is over when the beam points at (x, y): 0 facing backwards, 1/2 forwards, 1 backwards
// again. The sensor spins clockwise seen from above, so the azimuth falls from pi to -pi.
inline float kitti_turn_fraction(float x, float y) {
  constexpr float kTurnsPerRad = 0.5F * std::numbers::inv_pi_v<float>;
  return std::min(std::max(0.5F - fast_atan2(y, x) * kTurnsPerRad, 0.0F), 1.0F);
}

// Adds a constant to the elevation of a point and leaves its range and azimuth.
class ElevationCorrection {
 public:
  explicit ElevationCorrection(double angle_rad)
      : sin_(static_cast<float>(std::sin(angle_rad))), cos_(static_cast<float>(std::cos(angle_rad))) {}

  [[nodiscard]] bool off() const { return sin_ == 0; }

  // m. A point on the spin axis has no azimuth to turn towards and stays.
  void apply(float& x, float& y, float& z) const {
    const float rho = std::sqrt(x * x + y * y);
    if (rho == 0) return;
    const float scale = cos_ - z / rho * sin_;
    z = z * cos_ + rho * sin_;
    x *= scale;
    y *= scale;
  }

 private:
  float sin_, cos_;
};

}  // namespace lxd
