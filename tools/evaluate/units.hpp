// SPDX-License-Identifier: Apache-2.0
// What people read, in what the library computes in.
#pragma once

#include <numbers>

namespace lxd {

inline constexpr double kDegrees = 180 / std::numbers::pi;  // a radian
inline constexpr double kCentimetres = 100;                 // a metre
inline constexpr double kMillimetres = 1000;                // a metre
inline constexpr double kPerCent = 100;                     // one

}  // namespace lxd
