// SPDX-License-Identifier: Apache-2.0
// How the made building is divided: two floors alike in outline, a corridor along x (y = 0), rooms on both sides,
// stairs at the east end. And the way that a walk takes through it.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "tools/simulator/random.hpp"
#include "tools/simulator/world/walls.hpp"

namespace lxd::sim {

struct Room {
  Rect area;         // between the walls' middles
  double side;       // +1: north of the corridor, -1: south
  double door_x;     // the middle of its door
  bool glass_front;  // towards the corridor
  bool visited;      // by the walk

  [[nodiscard]] double corridor_y() const { return side > 0 ? area.low.y() : area.high.y(); }
};

struct FloorPlan {
  static constexpr double kCorridorHalf_m = 1.4;
  static constexpr double kStorey_m = 3.2;  // floor to floor
  static constexpr double kSlab_m = 0.25;
  static constexpr double kDoorHalf_m = 0.65;
  static constexpr double kDoor_m = 2.1;
  static constexpr double kLane_m = 0.35;  // the walk goes east on the right, west on the other side
  // The stairs.
  static constexpr int kSteps = 18;
  static constexpr double kRun_m = 0.27;
  static constexpr double kRise_m = kStorey_m / kSteps;
  static constexpr double kFlightHalf_m = 0.9;
  static constexpr double kFlightFrom_m = kCorridorHalf_m + 1.2;  // y of the first step's edge
  static constexpr double kFlightTo_m = kFlightFrom_m + kSteps * kRun_m;

  FloorPlan(Random& random);

  double east_m;            // the building's x is 0 .. east_m
  double north_m, south_m;  // y of the outer walls' middles
  Rect stairwell;
  std::vector<std::vector<Room>> floors;  // rooms, from west to east

  [[nodiscard]] Rect outline() const { return {{0, south_m}, {east_m, north_m}}; }
  [[nodiscard]] double flight_x() const { return stairwell.low.x() + 0.1 + kFlightHalf_m; }
  [[nodiscard]] double passage_x() const;  // beside the flight, on the upper floor
  // What is open above the flight.
  [[nodiscard]] Rect stair_hole() const;

  // From the corridor's west end through rooms, up, through rooms, and back the same stairs; closed.
  [[nodiscard]] std::vector<Eigen::Vector3d> walk() const;

 private:
  void divide(Random& random, std::vector<Room>& rooms, double to_x, double side) const;
};

}  // namespace lxd::sim
