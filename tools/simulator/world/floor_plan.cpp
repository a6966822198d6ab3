// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/floor_plan.hpp"

#include <algorithm>
#include <cmath>

#include "tools/simulator/world/route_shape.hpp"

namespace lxd::sim {
namespace {

constexpr double kPlanRing_m = 1.5;  // from a visited room's walls to the walk around its middle
constexpr double kWestEnd_m = 1.3;   // where the walk turns round
constexpr double kLanding_m = 0.75;  // beyond the last step, where it turns
constexpr double kWideStairs_m = 4.6;

// From the corridor into the room, once around its middle, and out again.
void visit(Line& corners, const Room& room, double lane) {
  const Rect ring{room.area.low.array() + kPlanRing_m, room.area.high.array() - kPlanRing_m};
  const double near = room.side > 0 ? ring.low.y() : ring.high.y();
  const double far = room.side > 0 ? ring.high.y() : ring.low.y();
  corners.insert(corners.end(), {{room.door_x, lane},
                                 {room.door_x, near},
                                 {ring.high.x(), near},
                                 {ring.high.x(), far},
                                 {ring.low.x(), far},
                                 {ring.low.x(), near},
                                 {room.door_x, near},
                                 {room.door_x, lane}});
}

}  // namespace

FloorPlan::FloorPlan(Random& random) : floors(2) {
  east_m = random.uniform(27, 30);
  north_m = kCorridorHalf_m + random.uniform(7.7, 8.4);
  south_m = -kCorridorHalf_m - random.uniform(7.7, 8.4);
  stairwell = {{east_m - kWideStairs_m, kCorridorHalf_m}, {east_m, north_m}};
  for (std::vector<Room>& rooms : floors) {
    divide(random, rooms, stairwell.low.x(), 1);
    divide(random, rooms, east_m, -1);
    std::ranges::sort(rooms, {}, &Room::door_x);
    for (std::size_t i = random.bits() % 2; i < rooms.size(); i += 1 + random.bits() % 3) rooms[i].visited = true;
  }
}

void FloorPlan::divide(Random& random, std::vector<Room>& rooms, double to_x, double side) const {
  constexpr double kWidth_m = 5.8;
  const int count = static_cast<int>(std::lround(to_x / kWidth_m));
  const double width = to_x / count;
  const int glazed = static_cast<int>(random.bits() % static_cast<unsigned>(count));
  double x = 0;
  for (int i = 0; i < count; ++i) {
    const double end = i + 1 == count ? to_x : (i + 1) * width + random.uniform(-0.4, 0.4);
    Room room{{{x, side > 0 ? kCorridorHalf_m : south_m}, {end, side > 0 ? north_m : -kCorridorHalf_m}},
              side,
              0,
              false,
              false};
    const double play = room.area.width_m() / 2 - kPlanRing_m - 0.75;
    room.door_x = room.area.middle().x() + random.uniform(-play, play);
    room.glass_front = side < 0 && i == glazed;
    rooms.push_back(room);
    x = end;
  }
}

double FloorPlan::passage_x() const { return (flight_x() + kFlightHalf_m + stairwell.high.x()) / 2; }

Rect FloorPlan::stair_hole() const {
  return {{stairwell.low.x() + 0.1, kFlightFrom_m}, {flight_x() + kFlightHalf_m + 0.05, kFlightTo_m}};
}

std::vector<Eigen::Vector3d> FloorPlan::walk() const {
  const double landing = kFlightTo_m + kLanding_m;
  Line corners{{kWestEnd_m, -kLane_m}};
  for (const Room& room : floors[0])
    if (room.visited && room.door_x > kWestEnd_m + 1 && room.door_x < flight_x() - 1) visit(corners, room, -kLane_m);
  corners.insert(corners.end(),
                 {{flight_x(), -kLane_m}, {flight_x(), landing}, {passage_x(), landing}, {passage_x(), kLane_m}});
  for (auto room = floors[1].rbegin(); room != floors[1].rend(); ++room)
    if (room->visited && room->door_x > kWestEnd_m + 1 && room->door_x < passage_x() - 1)
      visit(corners, *room, kLane_m);
  corners.insert(corners.end(), {{kWestEnd_m, kLane_m},
                                 {kWestEnd_m, -kLane_m},
                                 {passage_x(), -kLane_m},
                                 {passage_x(), landing},
                                 {flight_x(), landing},
                                 {flight_x(), kLane_m},
                                 {kWestEnd_m, kLane_m}});

  // On the flight the height follows from y; elsewhere it is the floor that was last reached.
  constexpr double kCorner_m = 0.5;
  constexpr double kStep_m = 0.5;
  const double foot_y = kFlightFrom_m - kRun_m;  // the line over the steps' edges meets the lower floor here
  std::vector<Eigen::Vector3d> way;
  double z = 0;
  for (const Eigen::Vector2d& at : rounded(corners, kCorner_m, kStep_m, true)) {
    const bool on_flight = std::abs(at.x() - flight_x()) < kFlightHalf_m && at.y() > kCorridorHalf_m;
    if (on_flight) z = std::clamp((at.y() - foot_y) / kRun_m * kRise_m, 0.0, kStorey_m);
    way.emplace_back(at.x(), at.y(), z);
  }
  return way;
}

}  // namespace lxd::sim
