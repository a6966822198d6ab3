// SPDX-License-Identifier: Apache-2.0
// About how much a recording will take, so that a disk without room is told before the work.
#pragma once

#include <cstdint>

#include "tools/simulator/scenario.hpp"
#include "tools/simulator/world/world.hpp"

namespace lxd::sim {

// To within a quarter, for images a half.
std::uint64_t expected_bytes(const Scenario& scenario, const World& world);

}  // namespace lxd::sim
