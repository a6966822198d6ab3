// SPDX-License-Identifier: Apache-2.0
// A walled yard, flat, with rows of parked cars: what a wheeled robot drives through.
#include <cmath>
#include <numbers>

#include "tools/simulator/world/planting.hpp"
#include "tools/simulator/world/route_shape.hpp"
#include "tools/simulator/world/things.hpp"
#include "tools/simulator/world/world_makers.hpp"

namespace lxd::sim {
namespace {

constexpr double kParkingQuarter_rad = std::numbers::pi / 2;
const Eigen::Vector2d kYardHalf_m{40, 30};
// Aisles along x between rows of cars; a row's cars stand nose to nose across it.
constexpr std::array<double, 3> kAisles_m{-19, 0, 19};
constexpr std::array<double, 2> kRows_m{-9.5, 9.5};
constexpr double kAisleEnd_m = 29;

// Round the yard, through the middle aisle, turning with the radius of a robot that cannot move sideways.
Line drive_line(Random& random) {
  constexpr double kRadius_m = 3.5;
  const double wander = random.uniform(-0.8, 0.8);
  constexpr double kBack_m = -24.5;  // the way back runs between the first aisle and the wall
  const double far = kAisleEnd_m + 4;
  const Line corners{{-kAisleEnd_m, kAisles_m[0]},
                     {kAisleEnd_m, kAisles_m[0] + wander},
                     {kAisleEnd_m, kAisles_m[1]},
                     {-kAisleEnd_m, kAisles_m[1] + wander},
                     {-kAisleEnd_m, kAisles_m[2]},
                     {far, kAisles_m[2] - wander},
                     {far, kBack_m},
                     {-kAisleEnd_m, kBack_m}};
  return rounded(corners, kRadius_m, 0.7, true);
}

void add_rows(Site& site, Planting& planting) {
  constexpr double kBay_m = 2.7;
  for (const double row : kRows_m) {
    for (const double side : {-1.0, 1.0}) {
      for (double x = -24; x < 25; x += kBay_m) {
        if (site.random.chance(0.3)) continue;
        const double off = site.random.uniform(-0.25, 0.25);
        const double turn = site.random.uniform(-0.05, 0.05) + (site.random.chance(0.7) ? 0 : std::numbers::pi);
        planting.car({x, row + side * (kCarHalfLength_m + 0.25) + off}, side * kParkingQuarter_rad + turn);
      }
    }
  }
}

void add_surroundings(Site& site, Planting& planting) {
  Random& random = site.random;
  const auto wall_height = random.uniform(1.2, 2.4);
  for (const double side : {-1.0, 1.0}) {
    planting.wall({0, side * kYardHalf_m.y()}, 0, 2 * kYardHalf_m.x(), wall_height, Surface::brick);
    planting.wall({side * kYardHalf_m.x(), side * 5}, kParkingQuarter_rad, 2 * kYardHalf_m.y() - 11, wall_height,
                  Surface::brick);
  }
  // Houses beyond the walls.
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector2d at = planting.somewhere({-75, -65}, {75, 65});
    if (std::abs(at.x()) < 52 && std::abs(at.y()) < 42) continue;
    const double half_x = random.uniform(6, 11);
    const double half_y = random.uniform(5, 8);
    const double height = random.uniform(5, 12);
    planting.house({at, {half_x, half_y}, random.uniform(-0.1, 0.1), height}, 2);
  }
}

void add_furniture(Site& site, Planting& planting) {
  Random& random = site.random;
  for (const double row : kRows_m)
    for (double x = -26; x < 30; x += random.uniform(12, 20)) planting.lamp_post({x, row}, kParkingQuarter_rad);
  for (int i = 0; i < 60; ++i) {
    const Eigen::Vector2d at = planting.somewhere(-kYardHalf_m, kYardHalf_m);
    const double yaw = random.chance(0.5) ? 0 : kParkingQuarter_rad;
    switch (i % 5) {
      case 0:
        planting.hedge(at, yaw, random.uniform(2, 5));
        break;
      case 1:
        planting.sign(at, random.uniform(-3, 3));
        break;
      case 2:
        planting.car(at, yaw);
        break;
      default:
        planting.tree(at, random.uniform(0.7, 1.1));
    }
  }
}

}  // namespace

World make_parking(std::uint64_t seed) {
  Site site("parking", seed);
  const Ground ground({-90, -80}, {90, 80}, 5, Relief(site.random, 0, 1));
  ground.add_to(site.mesh, [](const Eigen::Vector2d& at) {
    return (at.cwiseAbs() - kYardHalf_m).maxCoeff() < 0 ? Surface::asphalt : Surface::grass;
  });
  const Line drive = drive_line(site.random);
  site.add_route({"drive", ground.on(drive), true, 0.8}, {1.2, 0.5, 2.4});
  const Line walk = rounded(Line{{-24, -2}, {30, -2}, {30, 2}, {-24, 2}}, 1, 1, true);
  site.add_route({"walk", ground.on(walk), true, 0.6}, {0.9, 0.5, 2.4});

  Planting planting(site, ground);
  const double office = site.random.uniform(3.4, 4.2);
  planting.house({{-35.5, -12}, {2.5, site.random.uniform(5, 7)}, 0, office}, 0);
  add_surroundings(site, planting);
  add_rows(site, planting);
  add_furniture(site, planting);

  const Line crossing{{-33, kAisles_m[2] + 6}, {33, kAisles_m[2] + 6}};
  site.add_walker(ground.on(crossing), site.random.uniform(0, 60));
  const Line across{{27, -22}, {27, 22}};
  site.add_walker(ground.on(across), site.random.uniform(0, 40));
  const Line passing = rounded(Line{{-31, 15.6}, {31, 15.6}}, 1, 2, false);
  const double speed = site.random.uniform(2, 4);
  site.add_driver(ground.on(passing), speed, site.random.uniform(0, 60));
  return std::move(site.world);
}

}  // namespace lxd::sim
