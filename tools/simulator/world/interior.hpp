// SPDX-License-Identifier: Apache-2.0
// Furniture for the rooms of a plan, wherever the walk, doors and windows leave room for it.
#pragma once

#include "tools/simulator/world/floor_plan.hpp"
#include "tools/simulator/world/site.hpp"

namespace lxd::sim {

void furnish(Site& site, const FloorPlan& plan);

}  // namespace lxd::sim
