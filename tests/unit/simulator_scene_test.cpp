// SPDX-License-Identifier: Apache-2.0
// Rays into worlds: exact to the millimetre, the same every time, movers where they should be, texture with contrast.
#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <vector>

#include <Eigen/Geometry>
#include <gtest/gtest.h>

#include "tools/simulator/random.hpp"
#include "tools/simulator/world/scene.hpp"
#include "tools/simulator/world/texture.hpp"

namespace lxd::sim::simulator_scene_test {
namespace {

constexpr double kExact_m = 1e-3;

void add_triangle(World& world, const Eigen::Vector3f& a, const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  const auto first = static_cast<std::uint32_t>(world.vertices.size());
  world.vertices.insert(world.vertices.end(), {a, b, c});
  world.faces.push_back({first, first + 1, first + 2});
  world.face_material.push_back(0);
}

World world_of_one_material() {
  World world;
  world.materials.push_back({.name = "wall", .albedo = 0.5F, .contrast = 0.5F, .texel_m = 0.5F});
  return world;
}

Eigen::Vector3f random_vector(Random& random, double scale) {
  return {static_cast<float>(random.uniform(-scale, scale)), static_cast<float>(random.uniform(-scale, scale)),
          static_cast<float>(random.uniform(-scale, scale))};
}

World soup(const Eigen::Vector3f& centre, int count) {
  World world = world_of_one_material();
  Random random(1, "soup");
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3f at = centre + random_vector(random, 20);
    add_triangle(world, at, at + random_vector(random, 6), at + random_vector(random, 6));
  }
  return world;
}

std::vector<Ray> rays_from(const Eigen::Vector3f& origin, int count) {
  std::vector<Ray> rays;
  Random random(2, "rays");
  for (int i = 0; i < count; ++i) rays.push_back({origin, random_vector(random, 1).normalized()});
  return rays;
}

// Nearest crossing in double precision, by plane and three edges.
std::optional<double> brute_force(const World& world, const Ray& ray) {
  std::optional<double> nearest;
  const Eigen::Vector3d o = ray.origin_m.cast<double>();
  const Eigen::Vector3d d = ray.direction.cast<double>();
  for (const auto& face : world.faces) {
    const Eigen::Vector3d a = world.vertices[face[0]].cast<double>();
    const Eigen::Vector3d u = world.vertices[face[1]].cast<double>() - a;
    const Eigen::Vector3d v = world.vertices[face[2]].cast<double>() - a;
    Eigen::Matrix3d basis;
    basis << u, v, -d;
    const Eigen::Vector3d solved = basis.inverse() * (o - a);
    if (!(solved.x() >= 0 && solved.y() >= 0 && solved.x() + solved.y() <= 1 && solved.z() > 0)) continue;
    nearest = std::min(nearest.value_or(solved.z()), solved.z());
  }
  return nearest;
}

struct Agreement {
  int hits = 0;
  int other_surface = 0;  // one of the two slipped by an edge
  double worst_m = 0;
};

Agreement compare(const World& world, const std::vector<Ray>& rays) {
  const Scene scene(world);
  Agreement found;
  for (const Ray& ray : rays) {
    const Hit hit = scene.cast(ray);
    const auto expected = brute_force(world, ray);
    if (hit.found() != expected.has_value() || (expected && std::abs(hit.range_m - *expected) > 0.1)) {
      ++found.other_surface;
      continue;
    }
    if (!expected) continue;
    ++found.hits;
    found.worst_m = std::max(found.worst_m, std::abs(hit.range_m - *expected));
    EXPECT_LT(hit.normal.dot(ray.direction), 0);
  }
  return found;
}

TEST(SimulatorScene, AgreesWithBruteForceToTheMillimetre) {
  const World world = soup(Eigen::Vector3f::Zero(), 300);
  const Agreement found = compare(world, rays_from(Eigen::Vector3f(1, 2, 3), 2000));
  EXPECT_GT(found.hits, 1000);
  EXPECT_LE(found.other_surface, 1);
  EXPECT_LT(found.worst_m, kExact_m);
}

TEST(SimulatorScene, StaysExactAKilometreFromTheWorldsOrigin) {
  const Eigen::Vector3f far(-1200, 1500, 80);
  const World world = soup(far, 300);
  const Agreement found = compare(world, rays_from(far + Eigen::Vector3f(1, 2, 3), 2000));
  EXPECT_GT(found.hits, 1000);
  EXPECT_LE(found.other_surface, 1);
  EXPECT_LT(found.worst_m, kExact_m);
}

TEST(SimulatorScene, RangesAlongAThousandMetresOfFloorStayOnIt) {
  World world = world_of_one_material();
  add_triangle(world, {-2000, -2000, 0}, {2000, -2000, 0}, {0, 2000, 0});
  const Scene scene(world);
  for (float x = 1; x < 900; x *= 1.7F) {
    const Eigen::Vector3f origin(-300, 10, 1.8F);
    const Eigen::Vector3f direction = (Eigen::Vector3f(x - 300, 12, 0) - origin).normalized();
    const Hit hit = scene.cast(Ray{origin, direction});
    ASSERT_TRUE(hit.found());
    const Eigen::Vector3d point =
        origin.cast<double>() + static_cast<double>(hit.range_m) * direction.cast<double>().normalized();
    EXPECT_LT(std::abs(point.z()), kExact_m) << x;
  }
}

TEST(SimulatorScene, ManyRaysGiveWhatEachGives) {
  World world = soup(Eigen::Vector3f::Zero(), 300);
  world.movers.push_back({.half_m = {2, 1, 1}, .way_m = {{-5, 0, 0}, {5, 0, 0}}, .speed_mps = 3});
  const Scene scene(world);
  std::vector<Ray> rays = rays_from(Eigen::Vector3f(0, 8, 0), 500);
  for (std::size_t i = 0; i < rays.size(); ++i) rays[i].t_s = static_cast<float>(i) * 0.01F;
  std::vector<Hit> hits(rays.size());
  scene.cast(rays, hits);
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const Hit single = scene.cast(rays[i]);
    EXPECT_EQ(single.range_m, hits[i].range_m);
    EXPECT_EQ(single.albedo, hits[i].albedo);
    EXPECT_EQ(single.mover, hits[i].mover);
  }
  EXPECT_TRUE(std::ranges::any_of(hits, &Hit::mover));
}

TEST(SimulatorScene, RangeEndsWhereTheRaySays) {
  World world = world_of_one_material();
  add_triangle(world, {10, -50, -50}, {10, 50, -50}, {10, 0, 50});
  const Scene scene(world);
  EXPECT_TRUE(scene.cast({.origin_m = {0, 0, 0}, .direction = {1, 0, 0}, .range_max_m = 10.5F}).found());
  EXPECT_FALSE(scene.cast({.origin_m = {0, 0, 0}, .direction = {1, 0, 0}, .range_max_m = 9.5F}).found());
}

TEST(SimulatorScene, ARayOfNonsenseSeesNothing) {
  World world = world_of_one_material();
  add_triangle(world, {10, -50, -50}, {10, 50, -50}, {10, 0, 50});
  const Scene scene(world);
  const float nan = std::nanf("");
  EXPECT_FALSE(scene.cast({.origin_m = {nan, 0, 0}, .direction = {1, 0, 0}}).found());
  EXPECT_FALSE(scene.cast({.origin_m = {0, 0, 0}, .direction = {1, 0, nan}}).found());
  EXPECT_FALSE(scene.cast({.origin_m = {0, 0, 0}, .direction = {1, 0, 0}, .range_max_m = nan}).found());
  EXPECT_FALSE(scene.cast({.origin_m = {0, 0, HUGE_VALF}, .direction = {1, 0, 0}}).found());
}

TEST(SimulatorScene, AMoverGoesForthAndBack) {
  World world = world_of_one_material();
  add_triangle(world, {100, -500, -500}, {100, 500, -500}, {100, 0, 500});
  world.movers.push_back({.half_m = {0.5F, 0.5F, 1}, .way_m = {{10, 0, 0}, {20, 0, 0}}, .speed_mps = 1, .start_m = 2});
  const Scene scene(world);
  const auto range_at = [&](float t_s) {
    const Hit hit = scene.cast({.origin_m = {0, 0, 0}, .direction = {1, 0, 0}, .t_s = t_s});
    EXPECT_TRUE(hit.mover);
    EXPECT_EQ(hit.normal, Eigen::Vector3f(-1, 0, 0));
    return hit.range_m;
  };
  EXPECT_NEAR(range_at(0), 11.5F, 1e-4F);
  EXPECT_NEAR(range_at(3), 14.5F, 1e-4F);
  EXPECT_NEAR(range_at(10), 17.5F, 1e-4F);  // two metres on its way back
  EXPECT_NEAR(range_at(20), 11.5F, 1e-4F);
}

TEST(SimulatorScene, AMoverOnALoopTurnsWithIt) {
  World world = world_of_one_material();
  world.movers.push_back({.half_m = {2, 0.5F, 1},
                          .way_m = {{-10, 10, 0}, {10, 10, 0}, {10, 30, 0}, {-10, 30, 0}, {-10, 10, 0}},
                          .speed_mps = 10,
                          .start_m = 10});
  add_triangle(world, {-500, 100, -500}, {500, 100, -500}, {0, 100, 500});
  const Scene scene(world);
  // Broadside in front of the origin, then end on at the loop's far corner, then a whole turn later again.
  const Ray ahead{.origin_m = {0, 0, 0}, .direction = {0, 1, 0}};
  EXPECT_NEAR(scene.cast(ahead).range_m, 9.5F, 1e-4F);
  const Ray aside{.origin_m = {10, 0, 0}, .direction = {0, 1, 0}, .t_s = 2};
  EXPECT_NEAR(scene.cast(aside).range_m, 18, 1e-4F);
  EXPECT_NEAR(scene.cast({.origin_m = {0, 0, 0}, .direction = {0, 1, 0}, .t_s = 8}).range_m, 9.5F, 1e-4F);
  EXPECT_FALSE(scene.cast({.origin_m = {0, 0, 0}, .direction = {0, 1, 0}, .t_s = 2}).mover);
}

TEST(SimulatorScene, AMoverAroundTheOriginBlindsNobody) {
  World world = world_of_one_material();
  add_triangle(world, {10, -50, -50}, {10, 50, -50}, {10, 0, 50});
  world.movers.push_back({.way_m = {{0, 0, 0}, {0, 1, 0}}, .speed_mps = 0});
  const Hit hit = Scene(world).cast({.origin_m = {0, 0, 0}, .direction = {1, 0, 0}});
  EXPECT_FALSE(hit.mover);
  EXPECT_NEAR(hit.range_m, 10, 1e-4F);
}

TEST(SimulatorScene, TextureHasTheContrastThatItsMaterialAsksFor) {
  const Material plain{.name = "plain", .albedo = 0.5F, .contrast = 0};
  const Material rough{.name = "rough", .albedo = 0.5F, .contrast = 0.6F, .texel_m = 0.3F};
  double sum = 0;
  double squares = 0;
  constexpr int kSamples = 2000;
  Random random(3, "texture");
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector3f point = random_vector(random, 30);
    EXPECT_EQ(textured_albedo(plain, 0, point, Eigen::Vector3f::UnitZ(), 4e-3F), 0.5F);
    const double albedo = textured_albedo(rough, 0, point, Eigen::Vector3f::UnitZ(), 4e-3F);
    EXPECT_GE(albedo, 0.5 * 0.4 - 1e-6);
    EXPECT_LE(albedo, 0.5 * 1.6 + 1e-6);
    sum += albedo;
    squares += albedo * albedo;
  }
  const double mean = sum / kSamples;
  EXPECT_NEAR(mean, 0.5, 0.02);
  EXPECT_GT(std::sqrt(squares / kSamples - mean * mean), 0.05);
}

TEST(SimulatorScene, TextureStaysWithTheSurfaceAndFadesFarAway) {
  const Material material{.name = "wall", .albedo = 0.5F, .contrast = 0.6F, .texel_m = 0.3F};
  const Eigen::Vector3f point(3.21F, -7.5F, 1.9F);
  const Eigen::Vector3f normal = Eigen::Vector3f::UnitX();
  EXPECT_EQ(textured_albedo(material, 4, point, normal, 3e-3F), textured_albedo(material, 4, point, -normal, 3e-3F));
  EXPECT_NE(textured_albedo(material, 4, point, normal, 3e-3F), textured_albedo(material, 5, point, normal, 3e-3F));
  EXPECT_EQ(textured_albedo(material, 4, point, normal, 1.4F), 0.5F);
}

}  // namespace
}  // namespace lxd::sim::simulator_scene_test
