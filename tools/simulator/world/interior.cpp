// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/interior.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "tools/simulator/world/furniture.hpp"

namespace lxd::sim {
namespace {

constexpr double kInteriorQuarter_rad = std::numbers::pi / 2;
constexpr double kWallHalf_m = 0.15;  // of the thickest
constexpr double kGap_m = 0.02;

class Furnisher {
 public:
  Furnisher(Site& site, const Rect& area, double floor_z)
      : site_(site), random_(site.random), area_(area), floor_z_(floor_z) {
    area_.low.array() += kWallHalf_m;
    area_.high.array() -= kWallHalf_m;
  }

  void room() {
    table();
    constexpr int kTries = 26;
    for (int i = 0; i < kTries; ++i) wall_thing();
    for (int i = 0; i < 4; ++i) free_standing(i);
    lamps();
  }

  void corridor() {
    for (int i = 0; i < 30; ++i) poster();
    lamps();
  }

 private:
  [[nodiscard]] Placement on_floor(const Eigen::Vector2d& at, double yaw) const {
    return {{at.x(), at.y(), floor_z_}, yaw};
  }
  [[nodiscard]] bool take(const Eigen::Vector2d& at, const Eigen::Vector2d& half, double yaw, double low, double high) {
    return site_.take({at, half, yaw, floor_z_ + low, floor_z_ + high}, kGap_m);
  }

  // Somewhere along a wall (0 .. 3: south, east, north, west), a thing's back to it.
  [[nodiscard]] Placement against_wall(unsigned side, double width) {
    const bool lengthwise = side % 2 == 0;
    const double span = lengthwise ? area_.width_m() : area_.depth_m();
    const double s = random_.uniform(width / 2 + 0.03, span - width / 2 - 0.03);
    const double yaw = side * kInteriorQuarter_rad;
    switch (side) {
      case 0:
        return on_floor({area_.low.x() + s, area_.low.y()}, yaw);
      case 1:
        return on_floor({area_.high.x(), area_.low.y() + s}, yaw);
      case 2:
        return on_floor({area_.high.x() - s, area_.high.y()}, yaw);
      default:
        return on_floor({area_.low.x(), area_.high.y() - s}, yaw);
    }
  }

  void put_on_wall(const WallThing& thing) {
    const auto side = static_cast<unsigned>(random_.bits() % 4);
    const Placement back = against_wall(side, thing.width_m);
    const bool hangs = thing.kind == WallThing::Kind::poster;
    const Eigen::Vector3d middle = back.at(0, thing.depth_m / 2, 0);
    if (take(middle.head<2>(), {thing.width_m / 2, thing.depth_m / 2}, back.yaw_rad, hangs ? 1 : 0,
             thing.height_m + (hangs ? 1 : 0)))
      add_wall_thing(site_.mesh, random_, back, thing);
  }

  void wall_thing() {
    const WallThing thing = WallThing::random(random_);
    put_on_wall(thing);
  }

  void poster() {
    const double width = random_.uniform(0.6, 1.4);
    put_on_wall({WallThing::Kind::poster, width, 0.03, random_.uniform(0.5, 1.0)});
  }

  void table() {
    const double length = random_.uniform(1.3, 2.6);
    const double width = random_.uniform(0.7, 1.1);
    const Eigen::Vector2d middle = (area_.low + area_.high) / 2;
    if (!take(middle, {length / 2, width / 2}, kInteriorQuarter_rad, 0, 1.2)) return;
    const Placement at = on_floor(middle, kInteriorQuarter_rad);
    add_table(site_.mesh, random_, at, length, width);
    for (const double x : {-0.25, 0.25}) {
      chair(at.moved(x * length, width / 2 + 0.15, 0, -kInteriorQuarter_rad));
      chair(at.moved(x * length, -width / 2 - 0.15, 0, kInteriorQuarter_rad));
    }
    chair(at.moved(length / 2 + 0.3, 0, 0, std::numbers::pi));
    chair(at.moved(-length / 2 - 0.3, 0, 0));
  }

  // Half under the table: only the walk must pass.
  void chair(const Placement& wanted) {
    const double turn = random_.uniform(-0.3, 0.3);
    const Placement at = wanted.moved(0, 0, 0, turn);
    const Footprint print{at.foot_m.head<2>(), {0.24, 0.24}, at.yaw_rad, floor_z_, floor_z_ + 1};
    if (random_.chance(0.8) && site_.is_off_routes(print)) add_chair(site_.mesh, at);
  }

  void free_standing(int kind) {
    constexpr double kHalf_m = 0.3;
    for (int tries = 0; tries < 6; ++tries) {
      const Eigen::Vector2d spot{random_.uniform(area_.low.x() + 0.4, area_.high.x() - 0.4),
                                 random_.uniform(area_.low.y() + 0.4, area_.high.y() - 0.4)};
      const double high = kind == 0 ? FloorPlan::kStorey_m : 1.8;
      if (!take(spot, {kHalf_m, kHalf_m}, 0, 0, high)) continue;
      const Placement at = on_floor(spot, random_.uniform(-3, 3));
      if (kind == 0) return add_pillar(site_.mesh, at, 0.2, FloorPlan::kStorey_m - FloorPlan::kSlab_m);
      if (kind == 1) return add_floor_lamp(site_.mesh, at);
      if (kind == 2) return add_pot_plant(site_.mesh, random_, at);
      return add_chair(site_.mesh, at);
    }
  }

  void lamps() {
    const double z = FloorPlan::kStorey_m - FloorPlan::kSlab_m - 0.08;
    for (double x = area_.low.x() + 1.2; x < area_.high.x() - 0.7; x += 2.4)
      for (double y = area_.low.y() + 1.15; y < area_.high.y() - 0.4; y += 2.4)
        site_.mesh.box(on_floor({x, y}, 0).moved(0, 0, z), {1.2, 0.3, 0.1}, Surface::paint_white);
  }

  Site& site_;
  Random& random_;
  Rect area_;
  double floor_z_;
};

}  // namespace

void furnish(Site& site, const FloorPlan& plan) {
  const Rect corridor{{0, -FloorPlan::kCorridorHalf_m}, {plan.east_m, FloorPlan::kCorridorHalf_m}};
  for (std::size_t floor = 0; floor < plan.floors.size(); ++floor) {
    const double z = static_cast<double>(floor) * FloorPlan::kStorey_m;
    for (const Room& room : plan.floors[floor]) Furnisher(site, room.area, z).room();
    Furnisher(site, corridor, z).corridor();
  }
}

}  // namespace lxd::sim
