// SPDX-License-Identifier: Apache-2.0
// Grass and next to nothing on it: a LiDAR sees a plane, and knows neither its place nor its heading there.
#include "tools/simulator/world/planting.hpp"
#include "tools/simulator/world/route_shape.hpp"
#include "tools/simulator/world/world_makers.hpp"

namespace lxd::sim {

World make_field(std::uint64_t seed) {
  constexpr double kHalf_m = 260;
  constexpr double kCell_m = 5;
  Site site("field", seed);
  const Relief relief(site.random, 0.5, 240);
  const Ground ground(Eigen::Vector2d::Constant(-kHalf_m), Eigen::Vector2d::Constant(kHalf_m), kCell_m, relief);
  ground.add_to(site.mesh, [](const Eigen::Vector2d&) { return Surface::grass; });

  const Eigen::Vector2d half{site.random.uniform(40, 55), site.random.uniform(28, 40)};
  const Line drive = rounded(rectangle(Eigen::Vector2d::Zero(), half), 12, 1.5, true);
  const Line walk = rounded(rectangle({3, 2}, 0.7 * half), 5, 1.5, true);
  site.add_route({"drive", ground.on(drive), true, 2}, {2, 0.5, 3});
  site.add_route({"walk", ground.on(walk), true, 1}, {});

  // A lone tree and some posts, so far out that a LiDAR seldom sees them.
  Planting planting(site, ground);
  constexpr double kNear_m = 110;
  for (int posts = 0; posts < 6;) {
    const Eigen::Vector2d at = planting.somewhere(ground.low_m(), ground.high_m());
    if (at.norm() > kNear_m && planting.lamp_post(at, 0)) ++posts;
  }
  planting.tree({-kNear_m, site.random.uniform(-60, 60)}, 1.4);
  return std::move(site.world);
}

}  // namespace lxd::sim
