// SPDX-License-Identifier: Apache-2.0
// What stands indoors. Placements are on the floor; a thing for a wall has its back at the placement, y into the room.
#pragma once

#include "tools/simulator/world/mesh_builder.hpp"

namespace lxd::sim {

void add_table(MeshBuilder& mesh, Random& random, const Placement& at, double length_m, double width_m);
void add_chair(MeshBuilder& mesh, const Placement& at);  // its back towards -x
void add_pot_plant(MeshBuilder& mesh, Random& random, const Placement& at);
void add_floor_lamp(MeshBuilder& mesh, const Placement& at);
void add_pillar(MeshBuilder& mesh, const Placement& at, double radius_m, double height_m);

// A thing against a wall.
struct WallThing {
  enum class Kind { shelf, cabinet, desk, sofa, radiator, poster } kind;
  double width_m, depth_m, height_m;

  static WallThing random(Random& random);
};
void add_wall_thing(MeshBuilder& mesh, Random& random, const Placement& back, const WallThing& thing);
inline constexpr double kWallThingDepth_m = 0.65;  // at most

}  // namespace lxd::sim
