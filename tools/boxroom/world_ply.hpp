// SPDX-License-Identifier: Apache-2.0
// The true surfaces as a mesh file: what a map of the recording is compared with.
#pragma once

#include <string>

#include "tools/boxroom/world.hpp"

namespace lxd::boxroom {

// ASCII PLY, world frame, metres: the hall's inside and the boxes' outsides, two triangles a rectangle.
[[nodiscard]] std::string world_ply(const World& world);

}  // namespace lxd::boxroom
