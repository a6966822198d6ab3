// SPDX-License-Identifier: Apache-2.0
// Houses around a square on gentle relief, with trees, cars, hedges and kerbs.
#include <cmath>
#include <numbers>

#include "tools/simulator/world/planting.hpp"
#include "tools/simulator/world/route_shape.hpp"
#include "tools/simulator/world/things.hpp"
#include "tools/simulator/world/world_makers.hpp"

namespace lxd::sim {
namespace {

constexpr double kHalf_m = 100;
constexpr double kPitch_m = 60;           // of the blocks that houses stand on; the middle one is the square
constexpr double kRing_m = kPitch_m / 2;  // half side of the road around the square
constexpr double kRoadHalf_m = 3.2;
constexpr double kQuarter_rad = std::numbers::pi / 2;

// Low over the road, then up past the eaves and down again, never the same height for long.
std::vector<Eigen::Vector3d> flown(const Ground& ground, const Line& line, Random& random) {
  const double phase = random.uniform(0, 2 * std::numbers::pi);
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const double turn = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(line.size());
    points.push_back(ground.on(line[i], 6.5 + 2.3 * std::sin(3 * turn + phase) + 1.1 * std::sin(5 * turn)));
  }
  return points;
}

// A waving way around the square and once across it.
Line walk_line(Random& random) {
  Line corners;
  const auto side = [&](const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
    constexpr int kBends = 3;
    const Eigen::Vector2d along = (to - from).normalized();
    for (int i = 0; i < kBends; ++i) {
      const double part = (i + 0.2) / kBends;
      corners.push_back(LinePoint{from + part * (to - from), along}.left(random.uniform(-1.5, 1.5)));
    }
  };
  const double reach = kRing_m + 1;
  side({-reach, -reach}, {reach, -reach});
  side({reach, -reach}, {reach, reach});
  side({reach, reach}, {-reach, reach});
  side({-reach, reach}, {-reach, 6});
  corners.push_back({-reach, 4});
  corners.push_back({-12, random.uniform(-6, 6)});
  corners.push_back({6, random.uniform(-10, 10)});
  corners.push_back({0, -14});
  corners.push_back({-14, -16});
  return rounded(corners, 2.5, 1, true);
}

void add_routes(Site& site, const Ground& ground, const Line& road) {
  site.add_route({"walk", ground.on(walk_line(site.random)), true, 0.8}, {1.3, 0.5, 2.4});
  site.add_route({"drive", ground.on(road), true, 1.5}, {2.2, 0.5, 2.6});
  const Line line = rounded(
      rectangle({site.random.uniform(-2, 2), site.random.uniform(-2, 2)}, {kRing_m - 3, kRing_m - 2}), 8, 1.5, true);
  site.add_route({"fly", flown(ground, line, site.random), true, 1.2}, {2.5, 2, 2});
}

void add_houses(Site& site, Planting& planting) {
  Random& random = site.random;
  for (int j = -1; j <= 1; ++j) {
    for (int i = -1; i <= 1; ++i) {
      if (i == 0 && j == 0) continue;
      const double half_x = random.uniform(10, 17);
      const double half_y = random.uniform(7, 11);
      // Near enough to the road that a LiDAR sees the facade.
      const double x = i * (kRing_m + kRoadHalf_m + random.uniform(5, 9) + half_x);
      const double y = j * (kRing_m + kRoadHalf_m + random.uniform(5, 9) + half_y);
      const double yaw = random.uniform(-0.12, 0.12);
      const double height = random.uniform(5, 15);
      planting.house({{x, y}, {half_x, half_y}, yaw, height}, 2);
    }
  }
}

void park_cars(Site& site, Planting& planting, const Line& road) {
  const double length = length_m(road, true);
  for (double s = 6; s < length; s += site.random.uniform(14, 30)) {
    const auto in_a_row = 1 + site.random.bits() % 4;
    for (unsigned i = 0; i < in_a_row; ++i) {
      const LinePoint at = point_at(road, s + 2.8 * i, true);
      planting.car(at.left(-kRoadHalf_m - kCarHalfLength_m - 0.8), at.yaw_rad() + kQuarter_rad);
    }
  }
}

void scatter(Site& site, Planting& planting) {
  Random& random = site.random;
  const Eigen::Vector2d all = Eigen::Vector2d::Constant(kHalf_m - 4);
  const Eigen::Vector2d inner = Eigen::Vector2d::Constant(kRing_m + 16);
  for (int i = 0; i < 150; ++i) {
    const double scale = random.uniform(0.8, 1.5);
    planting.tree(planting.somewhere(-all, all), scale);
  }
  for (int i = 0; i < 120; ++i) {
    const Eigen::Vector2d at = planting.somewhere(-inner, inner);
    const double yaw = random.chance(0.5) ? 0 : kQuarter_rad;
    const double length = random.uniform(3, 9);
    switch (i % 5) {
      case 0:
        planting.hedge(at, yaw, length);
        break;
      case 1:
        planting.wall(at, yaw, length, random.uniform(0.8, 1.6), Surface::stone);
        break;
      case 2:
        planting.bench(at, yaw + random.uniform(-0.3, 0.3));
        break;
      case 3:
        planting.lamp_post(at, yaw);
        break;
      default:
        planting.sign(at, yaw + random.uniform(-1, 1));
    }
  }
}

void add_people(Site& site, const Ground& ground) {
  for (const double side : {-1.0, 1.0}) {
    const double beside = side * (kRing_m - kRoadHalf_m - 1.0);
    site.add_walker(ground.on(rounded(Line{{-25, beside}, {25, beside}}, 1, 2, false)), site.random.uniform(0, 40));
    site.add_walker(ground.on(rounded(Line{{beside, 24}, {beside, -22}}, 1, 2, false)), site.random.uniform(0, 40));
  }
}

}  // namespace

World make_campus(std::uint64_t seed) {
  Site site("campus", seed);
  const Relief relief(site.random, 2.2, 150);
  const Ground ground(Eigen::Vector2d::Constant(-kHalf_m), Eigen::Vector2d::Constant(kHalf_m), 2, relief);
  const Line road = rounded(rectangle(Eigen::Vector2d::Zero(), Eigen::Vector2d::Constant(kRing_m)), 8, 1.5, true);
  ground.add_to(site.mesh, [](const Eigen::Vector2d& at) {
    const double off = std::abs(at.cwiseAbs().maxCoeff() - kRing_m);
    if (off < kRoadHalf_m) return Surface::asphalt;
    return at.norm() < 9 ? Surface::paving : Surface::grass;
  });
  constexpr double kKerb_m = 0.1;
  add_kerb(site.mesh, ground, beside(road, -kRoadHalf_m), true, 0.2, kKerb_m, Surface::concrete);
  add_kerb(site.mesh, ground, beside(road, kRoadHalf_m), true, 0.2, kKerb_m, Surface::concrete);

  add_routes(site, ground, road);
  Planting planting(site, ground);
  add_houses(site, planting);
  park_cars(site, planting, road);
  scatter(site, planting);
  add_people(site, ground);
  return std::move(site.world);
}

}  // namespace lxd::sim
