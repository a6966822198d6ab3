// SPDX-License-Identifier: Apache-2.0
// A world of nothing but ways to go, for motions.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tools/simulator/world/world.hpp"

namespace lxd::test {

// A closed way of `corners` with every corner an arc of 15 m radius, as streets have; two metres of hills.
inline sim::Route street(const std::vector<Eigen::Vector2d>& corners) {
  constexpr double kRadius_m = 15, kHill_m = 2, kHills_m = 40;
  constexpr int kArc = 8;
  sim::Route route{"drive", {}, true, 2};
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d a = corners[i], b = corners[(i + 1) % corners.size()];
    const Eigen::Vector2d along = (b - a).normalized(), left(-along.y(), along.x());
    for (int k = 0; k <= kArc; ++k) {
      const double angle = k * std::numbers::pi / 2 / kArc;
      const Eigen::Vector2d p =
          b - kRadius_m * along + kRadius_m * (std::sin(angle) * along + (1 - std::cos(angle)) * left);
      route.way_m.emplace_back(p.x(), p.y(), kHill_m * std::sin(p.x() / kHills_m));
    }
  }
  return route;
}

inline sim::World world_of_ways() {
  sim::World world;
  world.name = "ways";
  world.routes = {
      {"walk", {{0, 0, 0}, {10, 0, 0}, {10, 8, 0}}, false, 0.6},  // a corridor with a corner
      {"stairs", {{0, 0, 0}, {4, 0, 0}, {9, 0, 3}, {12, 0, 3}, {12, 5, 3}}, false, 0.6},
      {"yard", {{0, 0, 0}, {20, 0, 0}, {20, 12, 0}, {5, 12, 0}, {5, 6, 0}, {0, 6, 0}}, true, 1.0},
      street({{0, 0}, {300, 0}, {300, 200}, {0, 200}}),  // 1 km
      {"lane", {{0, 0, 0}, {40, 0, 0}, {70, 5, 0}}, false, 2},
      {"fly", {{0, 0, 2}, {15, 0, 4}, {15, 20, 6}, {0, 25, 3}, {-5, 10, 2}}, true, 2.0},
      {"dead end", {{0, 0, 0}, {10, 0, 0}, {10, 10, 0}, {10, 2, 0}}, false, 1},
      {"speck", {{1, 1, 0}, {1, 1, 0}}, false, 1},
  };
  return world;
}

// The distance from a point to the nearest of a route, seen from above.
inline double off_route_m(const sim::Route& route, const Eigen::Vector3d& p) {
  double nearest = 1e9;
  const std::size_t legs = route.way_m.size() - (route.closed ? 0 : 1);
  for (std::size_t i = 0; i < legs; ++i) {
    const Eigen::Vector2d a = route.way_m[i].head<2>(), b = route.way_m[(i + 1) % route.way_m.size()].head<2>();
    const Eigen::Vector2d along = b - a;
    const double part = std::clamp((p.head<2>() - a).dot(along) / std::max(along.squaredNorm(), 1e-12), 0.0, 1.0);
    nearest = std::min(nearest, (p.head<2>() - a - part * along).norm());
  }
  return nearest;
}

}  // namespace lxd::test
