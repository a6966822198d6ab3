// SPDX-License-Identifier: Apache-2.0
// A straight tube with smooth walls: nothing tells a LiDAR how far along it is. Portals and some yard at both ends.
#include <cmath>
#include <numbers>

#include "tools/simulator/world/planting.hpp"
#include "tools/simulator/world/things.hpp"
#include "tools/simulator/world/world_makers.hpp"

namespace lxd::sim {
namespace {

constexpr double kLength_m = 420;  // along x, from 0
constexpr double kYard_m = 70;     // of open ground beyond each portal
constexpr double kHalfWidth_m = 45;
constexpr double kPortal_m = 12;  // height of the portal's wall

// The tube's inside and the hole in the portal: an arc on a flat road.
struct Tube {
  double radius_m, centre_m;  // centre's height over the road
  int sides = 48;

  [[nodiscard]] Eigen::Vector3d at(double x, int i) const {
    const double foot = std::asin(-centre_m / radius_m);  // where the arc meets the road, on the right
    const double angle = foot + (std::numbers::pi - 2 * foot) * i / sides;
    return {x, radius_m * std::cos(angle), centre_m + radius_m * std::sin(angle)};
  }
};

void add_tube(MeshBuilder& mesh, const Tube& tube) {
  constexpr double kSection_m = 10;
  for (double x = 0; x < kLength_m; x += kSection_m)
    for (int i = 0; i < tube.sides; ++i)
      mesh.quad(tube.at(x, i), tube.at(x + kSection_m, i), tube.at(x + kSection_m, i + 1), tube.at(x, i + 1),
                Surface::concrete);
}

// A wall across the whole yard with the tube's hole: strips upwards from the arc's upper half and sideways from its
// lower one.
void add_portal(MeshBuilder& mesh, const Tube& tube, double x) {
  for (int i = 0; i < tube.sides; ++i) {
    const Eigen::Vector3d a = tube.at(x, i);
    const Eigen::Vector3d b = tube.at(x, i + 1);
    const double edge = a.y() > 0 ? tube.radius_m : -tube.radius_m;
    if (a.z() + b.z() > 2 * tube.centre_m) {
      mesh.quad(a, b, {x, b.y(), kPortal_m}, {x, a.y(), kPortal_m}, Surface::stone);
    } else {
      mesh.quad(a, b, {x, edge, b.z()}, {x, edge, a.z()}, Surface::stone);
    }
  }
  for (const double side : {-1.0, 1.0})
    mesh.quad({x, side * tube.radius_m, 0}, {x, side * kHalfWidth_m, 0}, {x, side * kHalfWidth_m, kPortal_m},
              {x, side * tube.radius_m, kPortal_m}, Surface::stone);
}

void plant_yard(Site& site, const Ground& ground, double low_x, double high_x) {
  Planting planting(site, ground);
  const auto somewhere = [&] { return planting.somewhere({low_x, 8 - kHalfWidth_m}, {high_x, kHalfWidth_m - 8}); };
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector2d at = somewhere();
    const double half_x = site.random.uniform(4, 8);
    const double half_y = site.random.uniform(4, 7);
    const double height = site.random.uniform(4, 9);
    planting.house({at, {half_x, half_y}, 0, height}, 3);
  }
  for (int i = 0; i < 25; ++i) {
    const double scale = site.random.uniform(0.8, 1.3);
    planting.tree(somewhere(), scale);
  }
  for (int i = 0; i < 8; ++i) planting.lamp_post(somewhere(), 0);
  for (int i = 0; i < 12; ++i) {
    const double yaw = site.random.chance(0.5) ? 0 : std::numbers::pi / 2;
    planting.car(somewhere(), yaw);
  }
}

}  // namespace

World make_tunnel(std::uint64_t seed) {
  Site site("tunnel", seed);
  const double radius = site.random.uniform(4.2, 5);
  const Tube tube{radius, 0.3 * radius};
  const Ground ground({-kYard_m, -kHalfWidth_m}, {kLength_m + kYard_m, kHalfWidth_m}, 5, Relief(site.random, 0, 1));
  ground.add_to(site.mesh, [&](const Eigen::Vector2d& at) {
    return std::abs(at.y()) < 5 || (at.x() > 0 && at.x() < kLength_m) ? Surface::asphalt : Surface::grass;
  });
  add_tube(site.mesh, tube);
  add_portal(site.mesh, tube, 0);
  add_portal(site.mesh, tube, kLength_m);

  constexpr double kApproach_m = 45;
  const double lane = -0.3 * radius;
  const Line drive = rounded(Line{{-kApproach_m, lane}, {kLength_m + kApproach_m, lane}}, 1, 2, false);
  const Site::Room room{4, 0.5, 6};
  site.add_route({"drive", ground.on(drive), false, 1.5}, room);
  const Line oncoming{{kLength_m + kApproach_m, -lane}, {-kApproach_m, -lane}};
  site.keep_clear(ground.on(oncoming), false, room);
  site.add_driver(ground.on(oncoming), 12, site.random.uniform(0, kLength_m));

  site.occupy({{kLength_m / 2, 0}, {kLength_m / 2 + 1, kHalfWidth_m}});
  constexpr double kEdge_m = 10;  // nothing overhangs the world's end
  plant_yard(site, ground, -kYard_m + kEdge_m, -2);
  plant_yard(site, ground, kLength_m + 2, kLength_m + kYard_m - kEdge_m);
  return std::move(site.world);
}

}  // namespace lxd::sim
