// SPDX-License-Identifier: Apache-2.0
// What people write, in SI.
#pragma once

#include <numbers>

namespace lxd::sim {

inline constexpr double kDegree_rad = std::numbers::pi / 180;
inline constexpr double kPpm = 1e-6;

}  // namespace lxd::sim
