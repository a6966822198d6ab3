// SPDX-License-Identifier: Apache-2.0
// A building on two floors, closed all around: what it is made of; its furniture is interior.hpp's.
#include <array>
#include <cmath>
#include <numbers>

#include "tools/simulator/world/floor_plan.hpp"
#include "tools/simulator/world/interior.hpp"
#include "tools/simulator/world/site.hpp"
#include "tools/simulator/world/walls.hpp"
#include "tools/simulator/world/world_makers.hpp"

namespace lxd::sim {
namespace {

constexpr double kInner_m = 0.2;  // walls' thickness
constexpr double kOuter_m = 0.3;
constexpr double kInto_m = 0.02;  // walls reach this far into slabs, so that nothing is seen through the joint
constexpr double kSill_m = 0.95;
constexpr double kLintel_m = 2.25;

using Plan = FloorPlan;

class BuildingBuilder {
 public:
  BuildingBuilder(Site& site, const Plan& plan) : site_(site), plan_(plan) {}

  void build() {
    add_slabs();
    for (int floor = 0; floor < 2; ++floor) {
      add_outer_walls(floor);
      add_corridor_walls(floor);
      for (const Room& room : rooms(floor)) add_side_wall(room, floor);
      add_wall_between({plan_.stairwell.low, {plan_.stairwell.low.x(), plan_.north_m}}, floor);
    }
    add_stairs();
  }

 private:
  struct Ends {
    Eigen::Vector2d from, to;
  };
  [[nodiscard]] const std::vector<Room>& rooms(int floor) const {
    return plan_.floors[static_cast<std::size_t>(floor)];
  }
  [[nodiscard]] static Wall wall_on(const Ends& ends, double thickness, int floor) {
    const double z = floor * Plan::kStorey_m;
    return {ends.from, ends.to, thickness, z - kInto_m, z + Plan::kStorey_m - Plan::kSlab_m + kInto_m, {}};
  }

  void add_slabs() {
    constexpr double kFoundation_m = 0.3;
    constexpr double kCovering_m = 0.1;  // the upper part of a slab is floor, the lower one ceiling
    Rect area = plan_.outline();
    area.low.array() -= kOuter_m / 2;
    area.high.array() += kOuter_m / 2;
    const Rect none{area.low, area.low};
    const double ceiling = Plan::kStorey_m - Plan::kSlab_m;
    add_slab(site_.mesh, area, none, -kFoundation_m, 0, Surface::paving);
    add_slab(site_.mesh, area, plan_.stair_hole(), ceiling, Plan::kStorey_m - kCovering_m, Surface::ceiling);
    add_slab(site_.mesh, area, plan_.stair_hole(), Plan::kStorey_m - kCovering_m, Plan::kStorey_m, Surface::carpet);
    add_slab(site_.mesh, area, none, Plan::kStorey_m + ceiling, 2 * Plan::kStorey_m, Surface::ceiling);
    // Grass around it, for who looks from outside.
    constexpr double kLawn_m = 25;
    site_.mesh.block({area.low.x() - kLawn_m, area.low.y() - kLawn_m, -1},
                     {area.high.x() + kLawn_m, area.high.y() + kLawn_m, -kFoundation_m + 0.05}, Surface::grass);
  }

  // A window in the wall, and the wall's things kept off it.
  void add_window(Wall& wall, double middle, double half, int floor) {
    const double z = floor * Plan::kStorey_m;
    wall.openings.push_back({middle - half, middle + half, z + kSill_m, z + kLintel_m, true});
    const Eigen::Vector2d along = (wall.to - wall.from).normalized();
    const Eigen::Vector2d at = wall.from + middle * along;
    const bool lengthwise = std::abs(along.x()) > 0.5;
    const Eigen::Vector2d print = lengthwise ? Eigen::Vector2d{half, 0.8} : Eigen::Vector2d{0.8, half};
    site_.occupy({at, print, 0, z + kSill_m, z + kLintel_m});
  }

  void add_outer_walls(int floor) {
    const Rect o = plan_.outline();
    const std::array<Surface, 2> surfaces{Surface::plaster, Surface::plaster_warm};
    const Surface surface = surfaces[static_cast<std::size_t>(floor)];
    Wall south = wall_on({o.low, {o.high.x(), o.low.y()}}, kOuter_m, floor);
    Wall north = wall_on({{o.low.x(), o.high.y()}, o.high}, kOuter_m, floor);
    for (const Room& room : rooms(floor)) {
      Wall& wall = room.side > 0 ? north : south;
      const double quarter = room.area.width_m() / 4;
      const double half = site_.random.uniform(0.5, 0.8);
      for (const double off : {-quarter, quarter})
        if (site_.random.chance(0.7)) add_window(wall, room.area.middle().x() + off, half, floor);
    }
    Wall west = wall_on({o.low, {o.low.x(), o.high.y()}}, kOuter_m, floor);
    add_window(west, -o.low.y(), 0.8, floor);  // at the corridor's end
    add_wall(site_.mesh, south, surface);
    add_wall(site_.mesh, north, surface);
    add_wall(site_.mesh, west, surface);
    add_wall(site_.mesh, wall_on({{o.high.x(), o.low.y()}, o.high}, kOuter_m, floor), surface);
  }

  void add_door(Wall& wall, double middle, int floor) {
    const double z = floor * Plan::kStorey_m;
    wall.openings.push_back({middle - Plan::kDoorHalf_m, middle + Plan::kDoorHalf_m, z - kInto_m, z + Plan::kDoor_m});
    site_.occupy({{middle, wall.from.y()}, {Plan::kDoorHalf_m + 0.1, 1.1}, 0, z, z + Plan::kDoor_m});
  }

  void add_corridor_walls(int floor) {
    const double z = floor * Plan::kStorey_m;
    for (const double side : {-1.0, 1.0}) {
      const double y = side * Plan::kCorridorHalf_m;
      Wall wall = wall_on({{0, y}, {plan_.east_m, y}}, kInner_m, floor);
      for (const Room& room : rooms(floor)) {
        if (room.side != side) continue;
        add_door(wall, room.door_x, floor);
        if (!room.glass_front) continue;
        const double from = room.area.low.x() + 0.3;
        const double to = room.door_x - Plan::kDoorHalf_m - 0.3;
        wall.openings.push_back({from, to, z + 0.15, z + 2.3, true});
        site_.occupy({{(from + to) / 2, y}, {(to - from) / 2, 0.8}, 0, z, z + 2.3});
      }
      if (side > 0) add_door(wall, floor == 0 ? plan_.flight_x() : plan_.passage_x(), floor);
      add_wall(site_.mesh, wall, Surface::plaster);
    }
  }

  void add_wall_between(const Ends& ends, int floor) {
    add_wall(site_.mesh, wall_on(ends, kInner_m, floor), Surface::plaster_warm);
  }
  // The one to the next room in the east; the last has the outer wall, or the stairs' one.
  void add_side_wall(const Room& room, int floor) {
    const double x = room.area.high.x();
    const double last = room.side > 0 ? plan_.stairwell.low.x() : plan_.east_m;
    if (x < last) add_wall_between({{x, room.area.low.y()}, {x, room.area.high.y()}}, floor);
  }

  void add_stairs() {
    const Placement foot{{plan_.flight_x(), Plan::kFlightFrom_m, 0}, std::numbers::pi / 2};
    site_.mesh.stairs(foot, 2 * Plan::kFlightHalf_m, Plan::kRun_m, Plan::kRise_m, Plan::kSteps, Surface::wood_dark);
    const Rect hole = plan_.stair_hole();
    add_railing({hole.high, {hole.high.x(), hole.low.y()}});
    add_railing({hole.low, {hole.high.x(), hole.low.y()}});
    site_.occupy({hole.middle(), (hole.high - hole.low) / 2, 0});
  }

  void add_railing(const Ends& ends) {
    constexpr double kHeight_m = 1.0;
    constexpr double kEvery_m = 0.6;
    constexpr double kBar_m = 0.04;
    const Eigen::Vector2d along = ends.to - ends.from;
    const Placement start{{ends.from.x(), ends.from.y(), Plan::kStorey_m}, std::atan2(along.y(), along.x())};
    for (double s = 0; s <= along.norm(); s += kEvery_m)
      site_.mesh.box(start.moved(s, 0, -0.05), {kBar_m, kBar_m, kHeight_m}, Surface::metal);
    for (const double z : {0.3, 0.6, kHeight_m - kBar_m})
      site_.mesh.box(start.moved(along.norm() / 2, 0, z), {along.norm(), kBar_m, kBar_m}, Surface::metal);
  }

  Site& site_;
  const Plan& plan_;
};

void add_people(Site& site, const Plan& plan) {
  constexpr double kBeside_m = 0.98;  // of the corridor's middle
  for (int floor = 0; floor < 2; ++floor) {
    const double z = floor * Plan::kStorey_m;
    for (const double side : {-1.0, 1.0}) {
      const double y = side * kBeside_m;
      site.add_walker({{3, y, z}, {plan.stairwell.low.x() - 1, y, z}}, site.random.uniform(0, 40));
    }
  }
}

}  // namespace

World make_building(std::uint64_t seed) {
  Site site("building", seed);
  const Plan plan(site.random);
  site.add_route({"walk", plan.walk(), true, 0.5}, {0.62, 0.3, 2.0});
  BuildingBuilder(site, plan).build();
  furnish(site, plan);
  add_people(site, plan);
  return std::move(site.world);
}

}  // namespace lxd::sim
