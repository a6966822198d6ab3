// SPDX-License-Identifier: Apache-2.0
// The g of sensors that give accelerations in it.
#pragma once

namespace lxd {

inline constexpr double kStandardGravity_mps2 = 9.80665;

}  // namespace lxd
