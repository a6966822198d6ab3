// SPDX-License-Identifier: Apache-2.0
// The made worlds: the same for the same seed, closed where they should be.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tools/simulator/random.hpp"
#include "tools/simulator/world/mover_track.hpp"
#include "tools/simulator/world/scene.hpp"
#include "tools/simulator/world/surfaces.hpp"
#include "tools/simulator/world/world_makers.hpp"

namespace lxd::sim::simulator_world_test {
namespace {

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

class MadeWorld : public ::testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(Kinds, MadeWorld,
                         ::testing::Values("building", "campus", "street", "parking", "tunnel", "field"),
                         [](const auto& kind) { return std::string(kind.param); });

TEST_P(MadeWorld, IsTheSameForTheSameSeedAndAnotherForAnother) {
  const World a = *make_world(GetParam(), 7);
  const World b = *make_world(GetParam(), 7);
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.faces, b.faces);
  EXPECT_EQ(a.face_material, b.face_material);
  ASSERT_EQ(a.routes.size(), b.routes.size());
  for (std::size_t i = 0; i < a.routes.size(); ++i) EXPECT_EQ(a.routes[i].way_m, b.routes[i].way_m);
  EXPECT_NE(a.vertices, make_world(GetParam(), 8)->vertices);
}

TEST_P(MadeWorld, IsSound) {
  const World world = *make_world(GetParam(), 1);
  EXPECT_EQ(world.face_material.size(), world.faces.size());
  for (const auto& vertex : world.vertices) ASSERT_TRUE(vertex.allFinite());
  for (const auto& face : world.faces)
    for (const std::uint32_t corner : face) ASSERT_LT(corner, world.vertices.size());
  for (const std::uint16_t material : world.face_material) ASSERT_LT(material, world.materials.size());
  for (const Material& material : world.materials) {
    EXPECT_GT(material.albedo, 0);
    EXPECT_LE(material.albedo, 1);
    EXPECT_GT(material.contrast, 0) << material.name;
  }
}

double distance_m(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const double part = std::clamp((p - a).dot(b - a) / std::max((b - a).squaredNorm(), 1e-30), 0.0, 1.0);
  return (p - a - part * (b - a)).norm();
}

double distance_m(const Eigen::Vector3d& p, const World& world, std::uint32_t face) {
  std::array<Eigen::Vector3d, 3> c;
  for (std::size_t i = 0; i < 3; ++i) c[i] = world.vertices[world.faces[face][i]].cast<double>();
  const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
  bool within = true;
  double edges = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d& next = c[(i + 1) % 3];
    within = within && normal.dot((next - c[i]).cross(p - c[i])) >= 0;
    edges = std::min(edges, distance_m(p, c[i], next));
  }
  return within ? std::abs(normal.dot(p - c[0])) : edges;
}

TEST_P(MadeWorld, HitsLieOnTheFaceThatTheyName) {
  const World world = *make_world(GetParam(), 6);
  const Scene scene(world);
  Random random(2, "rays");
  const auto& way = world.routes.front().way_m;
  double worst = 0;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3d at = way[random.bits() % way.size()] + 1.3 * Eigen::Vector3d::UnitZ();
    const Eigen::Vector3d towards{random.normal(), random.normal(), 0.2 * random.normal()};
    const Ray ray{.origin_m = at.cast<float>(), .direction = towards.normalized().cast<float>()};
    const Hit hit = scene.cast(ray);
    if (!hit.found() || hit.mover) continue;
    ASSERT_EQ(hit.material, world.face_material[hit.face]);
    const Eigen::Vector3d point =
        ray.origin_m.cast<double>() + static_cast<double>(hit.range_m) * ray.direction.cast<double>();
    worst = std::max(worst, distance_m(point, world, hit.face));
  }
  EXPECT_LT(worst, 1e-3);
  EXPECT_GT(worst, 0);
}

TEST_P(MadeWorld, MoversMoveAndStandOnTheGround) {
  const World world = *make_world(GetParam(), 4);
  const Scene scene(world);
  for (const Mover& mover : world.movers) {
    const MoverTrack track(mover);
    EXPECT_GT((track.at(1).centre_m - track.at(0).centre_m).norm(), 0.3F);
    EXPECT_NEAR(track.at(2).heading.norm(), 1, 1e-5F);
    for (float t = 0; t < 200; t += 20) {
      const Hit floor =
          scene.cast({.origin_m = track.at(t).centre_m, .direction = -Eigen::Vector3f::UnitZ(), .movers = false});
      ASSERT_TRUE(floor.found());
      EXPECT_NEAR(floor.range_m, mover.half_m.z(), 0.35F);
    }
  }
}

TEST(SimulatorWorlds, AnUnknownKindNamesTheKnownOnes) {
  const auto world = make_world("castle", 0);
  ASSERT_FALSE(world.ok());
  EXPECT_NE(world.error().message.find("'castle'"), std::string::npos);
  for (const WorldKind& kind : world_kinds())
    EXPECT_NE(world.error().message.find(kind.name), std::string::npos) << kind.name;
}

TEST(SimulatorWorlds, NoRayLeavesTheBuilding) {
  const World world = *make_world("building", 0);
  const Scene scene(world);
  Eigen::AlignedBox3f walls;
  for (std::size_t i = 0; i < world.faces.size(); ++i)
    if (world.face_material[i] == static_cast<std::uint16_t>(Surface::plaster))
      for (const std::uint32_t corner : world.faces[i]) walls.extend(world.vertices[corner]);
  Random random(1, "rays");
  int glass = 0;
  for (const Eigen::Vector3d& at : along(*find_route(world, "walk"), 0.5, 1.3)) {
    for (int i = 0; i < 40; ++i) {
      const Eigen::Vector3f direction{static_cast<float>(random.normal()), static_cast<float>(random.normal()),
                                      static_cast<float>(random.normal())};
      const Ray ray{.origin_m = at.cast<float>(), .direction = direction.normalized()};
      const Hit hit = scene.cast(ray);
      ASSERT_TRUE(hit.found()) << at.transpose();
      const Eigen::Vector3f point = ray.origin_m + hit.range_m * ray.direction;
      EXPECT_LT(walls.exteriorDistance(point), 0.31F) << point.transpose();
      if (world.materials[hit.material].glass) ++glass;
    }
  }
  EXPECT_GT(glass, 20);
}

TEST(SimulatorWorlds, TheBuildingIsLargeAndHasTwoFloorsAndStairs) {
  for (const std::uint64_t seed : {0, 1, 104}) {
    const World world = *make_world("building", seed);
    const Route* const walk = find_route(world, "walk");
    const auto [low, high] = std::ranges::minmax(walk->way_m, {}, [](const Eigen::Vector3d& p) { return p.z(); });
    EXPECT_NEAR(low.z(), 0, 1e-9);
    EXPECT_NEAR(high.z(), 3.2, 1e-9);
    Eigen::AlignedBox3f walls;
    for (std::size_t i = 0; i < world.faces.size(); ++i)
      if (world.face_material[i] == static_cast<std::uint16_t>(Surface::plaster))
        for (const std::uint32_t corner : world.faces[i]) walls.extend(world.vertices[corner]);
    EXPECT_GE(walls.sizes().x(), 25);
    EXPECT_GE(walls.sizes().y(), 18);
  }
}

TEST(SimulatorWorlds, TheTunnelsCrossSectionDoesNotChange) {
  const World world = *make_world("tunnel", 0);
  const Scene scene(world);
  const auto ranges_at = [&](float x) {
    std::vector<float> ranges;
    for (int i = 0; i < 90; ++i) {
      const double angle = 2 * std::numbers::pi * i / 90;
      const Eigen::Vector3f direction(0, static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)));
      ranges.push_back(scene.cast({.origin_m = {x, 0, 1.5F}, .direction = direction, .movers = false}).range_m);
    }
    return ranges;
  };
  const std::vector<float> first = ranges_at(33);
  for (const float x : {101.5F, 222.2F, 390.F}) {
    const std::vector<float> other = ranges_at(x);
    for (std::size_t i = 0; i < first.size(); ++i) EXPECT_NEAR(first[i], other[i], 1e-4F);
  }
}

}  // namespace
}  // namespace lxd::sim::simulator_world_test
