// SPDX-License-Identifier: Apache-2.0
// What carried the state from the last sweep to this one.
#pragma once

#include <cstdint>

namespace lxd {

enum class MotionSource : std::uint8_t { constant_velocity, wheel, imu };

}  // namespace lxd
