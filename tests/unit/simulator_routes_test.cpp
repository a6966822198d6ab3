// SPDX-License-Identifier: Apache-2.0
// Routes through the made worlds can be gone, and motions that cannot be are found.
#include <algorithm>
#include <cmath>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tools/simulator/world/clearance.hpp"
#include "tools/simulator/world/mesh_builder.hpp"
#include "tools/simulator/world/scene.hpp"
#include "tools/simulator/world/surfaces.hpp"
#include "tools/simulator/world/world_makers.hpp"

namespace lxd::sim::simulator_routes_test {
namespace {

double length_m(const Route& route) {
  double length = route.closed ? (route.way_m.front() - route.way_m.back()).norm() : 0;
  for (std::size_t i = 1; i < route.way_m.size(); ++i) length += (route.way_m[i] - route.way_m[i - 1]).norm();
  return length;
}

// Positions every step_m along the route, this far over it.
std::vector<Eigen::Vector3d> along(const Route& route, double step_m, double above_m) {
  std::vector<Eigen::Vector3d> path;
  const std::size_t n = route.way_m.size();
  for (std::size_t i = 0; i + (route.closed ? 0 : 1) < n; ++i) {
    const Eigen::Vector3d step = route.way_m[(i + 1) % n] - route.way_m[i];
    const int steps = std::max(1, static_cast<int>(std::ceil(step.norm() / step_m)));
    for (int k = 0; k < steps; ++k)
      path.emplace_back(route.way_m[i] + step * k / steps + above_m * Eigen::Vector3d::UnitZ());
  }
  return path;
}

class MadeRoutes : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Kinds, MadeRoutes,
                         ::testing::Values("building", "campus", "street", "parking", "tunnel", "field"),
                         [](const auto& kind) { return std::string(kind.param); });

TEST_P(MadeRoutes, KeepTheirClearance) {
  // The street is the same maker's work over and over along a kilometre: fewer seeds show as much.
  const bool large = std::string(GetParam()) == "street";
  for (const std::uint64_t seed : {0, 1, 2, 3, 4, 100, 101, 102, 103, 104}) {
    if (large && seed % 100 != 0) continue;
    const World world = *make_world(GetParam(), seed);
    const Scene scene(world);
    ASSERT_FALSE(world.routes.empty());
    for (const Route& route : world.routes) {
      EXPECT_GE(route.clearance_m, 0.5);
      const double above_m = route.name == "fly" ? 0 : 1;
      const auto path = along(route, 0.5, above_m);
      const auto found = first_collision(scene, path, {.radius_m = route.clearance_m});
      EXPECT_FALSE(found.has_value()) << route.name << " of seed " << seed << ": " << path[found->index].transpose()
                                      << " " << found->what;
    }
  }
}

TEST_P(MadeRoutes, LieOnTheGround) {
  const World world = *make_world(GetParam(), 2);
  const Scene scene(world);
  for (const Route& route : world.routes) {
    for (const Eigen::Vector3d& at : route.way_m) {
      const Ray down{.origin_m = (at + 0.5 * Eigen::Vector3d::UnitZ()).cast<float>(),
                     .direction = -Eigen::Vector3f::UnitZ(),
                     .movers = false};
      const double height = scene.cast(down).range_m - 0.5;
      if (route.name == "fly") {
        EXPECT_GT(height, 2.5);
        EXPECT_LT(height, 10.5);
      } else {
        EXPECT_NEAR(height, 0, 0.2) << route.name << " " << at.transpose();  // a step's rise
      }
    }
  }
}

TEST_P(MadeRoutes, TurnsOfTheDriveAreWide) {
  const World world = *make_world(GetParam(), 3);
  const Route* const drive = find_route(world, "drive");
  if (drive == nullptr) return;  // nobody drives in the building
  const auto& way = drive->way_m;
  for (std::size_t i = 1; i + 1 < way.size(); ++i) {
    const Eigen::Vector2d a = (way[i] - way[i - 1]).head<2>();
    const Eigen::Vector2d b = (way[i + 1] - way[i]).head<2>();
    const double turn = std::abs(std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)));
    EXPECT_GT((a.norm() + b.norm()) / 2, 1.5 * turn) << way[i].transpose();
  }
}

TEST(SimulatorRoutes, TheStreetsLoopIsLongerThanAKilometre) {
  for (const std::uint64_t seed : {0, 101}) {
    const World world = *make_world("street", seed);
    const Route* const drive = find_route(world, "drive");
    ASSERT_NE(drive, nullptr);
    EXPECT_TRUE(drive->closed);
    EXPECT_GE(length_m(*drive), 1000);
    const auto [low, high] = std::ranges::minmax(drive->way_m, {}, [](const Eigen::Vector3d& p) { return p.z(); });
    EXPECT_GT(high.z() - low.z(), 1) << "no relief";
  }
}

TEST(SimulatorRoutes, EveryKindHasItsRoutes) {
  const auto length_of = [](const char* kind, const char* route) {
    const World world = *make_world(kind, 5);
    const Route* const found = find_route(world, route);
    return found == nullptr ? 0 : length_m(*found);
  };
  EXPECT_GT(length_of("building", "walk"), 150);
  EXPECT_GT(length_of("campus", "walk"), 200);
  EXPECT_GT(length_of("campus", "fly"), 150);
  EXPECT_GT(length_of("campus", "drive"), 150);
  EXPECT_GT(length_of("parking", "drive"), 200);
  EXPECT_GE(length_of("tunnel", "drive"), 300);
  EXPECT_GE(length_of("field", "drive"), 200);
  EXPECT_GE(length_of("field", "walk"), 200);
}

class PathInABox : public ::testing::Test {
 protected:
  PathInABox() : world_(*make_world("field", 0)), scene_(world_) {}
  [[nodiscard]] std::string wrong(const std::vector<Eigen::Vector3d>& path) const {
    const auto found = first_collision(scene_, path);
    return found ? std::to_string(found->index) + " " + found->what : "";
  }
  World world_;
  Scene scene_;
};

TEST_F(PathInABox, FindsWhereAPathLeavesTheWorldOrGoesUnderground) {
  EXPECT_EQ(wrong({{0, 0, 2}, {1, 0, 2}, {2, 0, 2}}), "");
  EXPECT_EQ(wrong({{0, 0, 2}, {1, 0, 2}, {2, 400, 2}}), "2 leaves the world");
  EXPECT_EQ(wrong({{0, 0, 2}, {1, 0, 2000}}), "1 leaves the world");
  EXPECT_EQ(wrong({{0, 0, 2}, {1, 0, std::nan("")}}), "1 is not finite");
  EXPECT_NE(wrong({{0, 0, 2}, {0, 0, -0.55}}), "");
}

TEST(SimulatorClearance, FindsWallsThatAreCrossedOrTooNear) {
  World world;
  world.materials = standard_materials();
  MeshBuilder mesh(world);
  mesh.block({-20, -20, -1}, {20, 20, 0}, Surface::asphalt);
  mesh.block({5, -20, 0}, {5.2, 20, 3}, Surface::brick);
  world.movers.push_back({.way_m = {{2, 0, 1}, {2, 0.1F, 1}}});
  const Scene scene(world);
  const auto wrong = [&](const std::vector<Eigen::Vector3d>& path) {
    const auto found = first_collision(scene, path, {.radius_m = 0.4});
    return found ? std::to_string(found->index) + " " + found->what : "";
  };
  EXPECT_EQ(wrong({{0, 0, 1}, {2, 0, 1}, {4, 0, 1}}), "") << "movers do not count";
  EXPECT_EQ(wrong({{0, 0, 1}, {4.7, 0, 1}}), "1 is 0.30 m from brick");
  EXPECT_EQ(wrong({{0, 0, 1}, {4, 0, 1}, {6, 0, 1}}), "2 is behind brick, seen from the position before");
  EXPECT_EQ(wrong({{0, 0, 1}, {4, 0, 3.5}, {6, 0, 3.5}}), "");
  EXPECT_EQ(wrong({{0, 0, 0.04}}), "0 is 0.04 m above asphalt");
}

}  // namespace
}  // namespace lxd::sim::simulator_routes_test
