// SPDX-License-Identifier: Apache-2.0
// Points of a cell that fit no layer yet. They wait, quantised to the cell, until they make a layer of their own.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <Eigen/Core>

namespace lxd {

inline constexpr int kWaitingMax = 32;

struct WaitingPoint {
  std::array<std::uint16_t, 3> position;  // 65536ths of the cell's edge
  std::uint16_t sigma;                    // 0.1 mm
};

struct WaitingBlock {
  std::array<WaitingPoint, kWaitingMax> points;
  std::uint32_t cell;        // whose points they are
  std::uint32_t last_sweep;  // that brought one
  std::uint32_t offered;     // points that came since the last attempt, and those it left
  std::uint16_t count;
  std::uint16_t next_attempt;        // count at which a layer is tried
  Eigen::Vector3f towards_sensor_m;  // from the cell's centre, when the last point came
};

inline constexpr float kWaitingSteps = 65535.0f;
inline constexpr float kWaitingSigmaUnit_m = 1e-4f;

inline WaitingPoint quantise(const Eigen::Vector3f& p_cell_m, float sigma_m, float inverse_cell_size) {
  const auto code = [](float x) { return static_cast<std::uint16_t>(std::clamp(x, 0.0f, kWaitingSteps)); };
  const Eigen::Vector3f q = p_cell_m * (inverse_cell_size * kWaitingSteps);
  return {{code(q.x()), code(q.y()), code(q.z())}, code(sigma_m / kWaitingSigmaUnit_m)};
}

inline Eigen::Vector3f position_of(const WaitingPoint& p, float cell_size_m) {
  return Eigen::Vector3f(p.position[0], p.position[1], p.position[2]) * (cell_size_m / kWaitingSteps);
}

inline float variance_of(const WaitingPoint& p) {
  const float sigma = static_cast<float>(p.sigma) * kWaitingSigmaUnit_m;
  return sigma * sigma;
}

}  // namespace lxd
