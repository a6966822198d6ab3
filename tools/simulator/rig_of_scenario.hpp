// SPDX-License-Identifier: Apache-2.0
// The rig file of a scenario: what the product is told of the sensors, which is their calibration and not their errors.
#pragma once

#include <cstdint>

#include "board/rig.hpp"
#include "tools/simulator/scenario.hpp"

namespace lxd::sim {

// The reference is the IMU when it sits at the body's origin, else a frame of its own, `body`.
Rig rig_of(const Scenario& scenario, std::uint64_t seed);

}  // namespace lxd::sim
