// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/furniture.hpp"

#include <algorithm>
#include <array>

namespace lxd::sim {
namespace {

constexpr double kBoard_m = 0.03;

void add_legs(MeshBuilder& mesh, const Placement& at, double length, double width, double height, double side) {
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      mesh.box(at.moved(x * (length - 2 * side), y * (width - 2 * side), 0), {side, side, height}, Surface::metal);
}

// Books, boxes and screens on a board.
void add_clutter(MeshBuilder& mesh, Random& random, const Placement& board, double length, double width,
                 double height) {
  static constexpr std::array kCovers{Surface::paint_red, Surface::paint_blue, Surface::paint_white, Surface::black,
                                      Surface::poster,    Surface::fabric,     Surface::wood_dark};
  for (double x = -length / 2 + 0.05; x < length / 2 - 0.2;) {
    const double wide = random.uniform(0.05, 0.3);
    const double deep = width * random.uniform(0.5, 0.8);
    const double high = height * random.uniform(0.4, 0.95);
    const Surface cover = kCovers[random.bits() % kCovers.size()];
    if (random.chance(0.7)) mesh.box(board.moved(x + wide / 2, 0, 0), {0.95 * wide, deep, high}, cover);
    x += wide + random.uniform(0, 0.1);
  }
}

void add_shelf(MeshBuilder& mesh, Random& random, const Placement& at, const WallThing& thing) {
  constexpr double kStorey_m = 0.38;
  const Surface wood = random.chance(0.5) ? Surface::wood : Surface::wood_dark;
  for (const double side : {-0.5, 0.5})
    mesh.box(at.moved(side * (thing.width_m - kBoard_m), 0, 0), {kBoard_m, thing.depth_m, thing.height_m}, wood);
  mesh.box(at.moved(0, -thing.depth_m / 2 + 0.01, 0), {thing.width_m, 0.02, thing.height_m}, wood);
  for (double z = 0.05; z < thing.height_m; z += kStorey_m) {
    mesh.box(at.moved(0, 0, z), {thing.width_m - 2 * kBoard_m, thing.depth_m - 0.02, kBoard_m}, wood);
    if (z + kStorey_m < thing.height_m)
      add_clutter(mesh, random, at.moved(0, 0, z + kBoard_m), thing.width_m - 0.1, thing.depth_m, kStorey_m - 0.06);
  }
}

void add_cabinet(MeshBuilder& mesh, Random& random, const Placement& at, const WallThing& thing) {
  const Surface body = random.chance(0.5) ? Surface::metal : Surface::wood;
  mesh.box(at, {thing.width_m, thing.depth_m, thing.height_m}, body);
  for (const double side : {-0.06, 0.06})
    mesh.box(at.moved(side, thing.depth_m / 2 + 0.015, 0.5 * thing.height_m), {0.02, 0.03, 0.16}, Surface::black);
  mesh.box(at.moved(0, thing.depth_m / 2 + 0.002, 0.05), {0.012, 0.004, thing.height_m - 0.1}, Surface::black);
}

void add_sofa(MeshBuilder& mesh, const Placement& at, const WallThing& thing) {
  mesh.box(at.moved(0, 0, 0.08), {thing.width_m, thing.depth_m, 0.34}, Surface::fabric);
  mesh.box(at.moved(0, -thing.depth_m / 2 + 0.1, 0.42), {thing.width_m, 0.2, thing.height_m - 0.42}, Surface::fabric);
  for (const double side : {-0.5, 0.5})
    mesh.box(at.moved(side * (thing.width_m - 0.18), 0.02, 0.42), {0.18, thing.depth_m - 0.05, 0.2}, Surface::fabric);
}

void add_radiator(MeshBuilder& mesh, const Placement& at, const WallThing& thing) {
  for (double x = -thing.width_m / 2 + 0.04; x < thing.width_m / 2; x += 0.08)
    mesh.box(at.moved(x, 0, 0.12), {0.05, thing.depth_m, thing.height_m}, Surface::paint_white);
}

}  // namespace

void add_table(MeshBuilder& mesh, Random& random, const Placement& at, double length_m, double width_m) {
  constexpr double kHeight_m = 0.74;
  add_legs(mesh, at, length_m, width_m, kHeight_m, 0.05);
  mesh.box(at.moved(0, 0, kHeight_m), {length_m, width_m, 0.04}, Surface::wood);
  add_clutter(mesh, random, at.moved(0, 0, kHeight_m + 0.04), 0.8 * length_m, 0.5 * width_m, 0.4);
}

void add_chair(MeshBuilder& mesh, const Placement& at) {
  constexpr double kSeat_m = 0.44;
  add_legs(mesh, at, 0.44, 0.44, kSeat_m, 0.03);
  mesh.box(at.moved(0, 0, kSeat_m), {0.44, 0.44, 0.05}, Surface::fabric);
  mesh.box(at.moved(-0.2, 0, kSeat_m + 0.12), {0.04, 0.42, 0.36}, Surface::fabric);
}

void add_pot_plant(MeshBuilder& mesh, Random& random, const Placement& at) {
  mesh.cylinder(at.at(0, 0, 0), at.at(0, 0, 0.35), 0.14, 0.19, 12, Surface::brick);
  mesh.leaves(random, at.at(0, 0, 0.85), {0.3, 0.3, 0.45}, 140, 0.14);
}

void add_floor_lamp(MeshBuilder& mesh, const Placement& at) {
  mesh.cylinder(at.at(0, 0, 0), at.at(0, 0, 0.03), 0.15, 0.15, 16, Surface::metal);
  mesh.cylinder(at.at(0, 0, 0.03), at.at(0, 0, 1.5), 0.015, 0.015, 8, Surface::metal);
  mesh.cylinder(at.at(0, 0, 1.45), at.at(0, 0, 1.75), 0.2, 0.12, 16, Surface::paint_white);
}

void add_pillar(MeshBuilder& mesh, const Placement& at, double radius_m, double height_m) {
  mesh.cylinder(at.at(0, 0, -0.02), at.at(0, 0, height_m + 0.02), radius_m, radius_m, 24, Surface::concrete);
}

WallThing WallThing::random(Random& random) {
  switch (random.bits() % 9) {
    case 0:
    case 1:
    case 2: {
      const double width = random.uniform(0.8, 2.0);
      return {Kind::shelf, width, random.uniform(0.28, 0.42), random.uniform(1.3, 2.2)};
    }
    case 3:
    case 4: {
      const double width = random.uniform(0.6, 1.4);
      return {Kind::cabinet, width, random.uniform(0.4, 0.58), random.uniform(0.8, 2.0)};
    }
    case 5:
      return {Kind::desk, random.uniform(1.2, 1.7), kWallThingDepth_m, 0.74};
    case 6:
      return {Kind::sofa, random.uniform(1.4, 2.0), kWallThingDepth_m, 0.85};
    case 7:
      return {Kind::radiator, random.uniform(0.7, 1.5), 0.12, 0.6};
    default:
      return {Kind::poster, random.uniform(0.7, 1.6), 0.03, random.uniform(0.6, 1.1)};
  }
}

void add_wall_thing(MeshBuilder& mesh, Random& random, const Placement& back, const WallThing& thing) {
  const Placement middle = back.moved(0, thing.depth_m / 2 + 0.005, 0);
  switch (thing.kind) {
    case WallThing::Kind::shelf:
      return add_shelf(mesh, random, middle, thing);
    case WallThing::Kind::cabinet:
      return add_cabinet(mesh, random, middle, thing);
    case WallThing::Kind::desk:
      return add_table(mesh, random, middle, thing.width_m, thing.depth_m);
    case WallThing::Kind::sofa:
      return add_sofa(mesh, middle, thing);
    case WallThing::Kind::radiator:
      return add_radiator(mesh, middle, thing);
    case WallThing::Kind::poster:
      return mesh.box(middle.moved(0, 0, 1), {thing.width_m, thing.depth_m, thing.height_m}, Surface::poster);
  }
}

}  // namespace lxd::sim
