// SPDX-License-Identifier: Apache-2.0
// atan2 for azimuths of some hundred thousand points a sweep, where 1e-4 rad (1.6 us of a 0.1 s turn) is plenty.
// Branch-free, so that the compiler can take several points at once.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lxd {

// rad in [-pi, pi]; error below 2e-6 rad for finite arguments that are not both zero; (0, 0) gives 0.
// An odd minimax polynomial of degree 11 for atan on [0, 1] (of the family of Abramowitz & Stegun 4.4.49), unfolded
// over the octants.
inline float fast_atan2(float y, float x) {
  constexpr float kPi = std::numbers::pi_v<float>;
  constexpr float kTiny = 1e-30F;  // m; keeps 0/0 out
  const float ax = std::abs(x), ay = std::abs(y);
  const float q = std::min(ax, ay) / std::max(std::max(ax, ay), kTiny);
  const float s = q * q;
  float a = -0.01172120F;
  a = a * s + 0.05265332F;
  a = a * s - 0.11643287F;
  a = a * s + 0.19354346F;
  a = a * s - 0.33262347F;
  a = (a * s + 0.99997726F) * q;
  a = ay > ax ? kPi / 2 - a : a;
  a = x < 0 ? kPi - a : a;
  return std::copysign(a, y);
}

}  // namespace lxd
