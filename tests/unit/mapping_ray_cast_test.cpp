// SPDX-License-Identifier: Apache-2.0
// Rays into the map: against planes and boxes, along lattice borders, through holes, and against the extracted mesh.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/cast_scene.hpp"

namespace lxd::mapping_ray_cast_test {
namespace {

using Eigen::Vector3d;
using test::CastScene;

Ray towards(const Vector3d& from, const Vector3d& to, double range_m = 60) {
  return {from, (to - from).normalized(), range_m};
}

class RayCastTest : public testing::Test {
 protected:
  RayHit hit{};
  CastScene scene;
};

// A floor of 8 m x 8 m at z = 0.23, seen from 2 m above.
class FloorCastTest : public RayCastTest {
 protected:
  FloorCastTest() {
    scene.add_patch({0, 0, 0.23F}, {8, 0, 0}, {0, 8, 0}, 0.025F);
    scene.fuse({4, 4, 2.2F});
  }
};

TEST_F(RayCastTest, AnEmptyMapIsNotHit) { EXPECT_FALSE(cast_ray(scene.map, towards({0, 0, 0}, {1, 0, 0}), hit)); }

// All rays but the few at quads that no return happened to fall on.
TEST_F(FloorCastTest, MeetsThePlaneFromAbove) {
  constexpr int kRays = 2000;
  std::uniform_real_distribution<double> any(0.2, 7.8), height(0.5, 3);
  int met = 0;
  for (int i = 0; i < kRays; ++i) {
    const Vector3d from(any(scene.random), any(scene.random), height(scene.random));
    const Vector3d to(any(scene.random), any(scene.random), 0.23);
    const double truth_m = (to - from).norm();
    if (!cast_ray(scene.map, towards(from, to), hit)) continue;
    ++met;
    const double tolerance_m = 4e-3 * truth_m / (from.z() - 0.23) + 3 * std::sqrt(hit.variance_m2);
    EXPECT_NEAR(hit.distance_m, truth_m, tolerance_m);
    EXPECT_LT((hit.position_m - to).norm(), tolerance_m);
    EXPECT_GT(hit.normal.z(), 0.98F);
    EXPECT_TRUE(hit.front && hit.seen);
  }
  EXPECT_GT(met, kRays - 5);
}

TEST_F(FloorCastTest, FromBelowItIsTheBack) {
  ASSERT_TRUE(cast_ray(scene.map, towards({4, 4, -3}, {4.1, 4.1, 0.23}), hit));
  EXPECT_NEAR(hit.position_m.z(), 0.23, 3e-3);
  EXPECT_FALSE(hit.front);
  EXPECT_LT(hit.normal.z(), -0.99F);
}

// The same surface from steeper and flatter: the variance of the distance goes with one over the squared cosine.
TEST_F(FloorCastTest, TheVarianceIsAlongTheRay) {
  RayHit steep{}, flat{};
  const Vector3d p(4.25, 4.25, 0.23);
  ASSERT_TRUE(cast_ray(scene.map, towards(p + 2 * Vector3d::UnitZ(), p), steep));
  ASSERT_TRUE(cast_ray(scene.map, towards(p + 4 * Vector3d(-std::cos(0.2), 0, std::sin(0.2)), p), flat));
  EXPECT_NEAR(std::sqrt(flat.variance_m2 / steep.variance_m2), 1 / std::sin(0.2), 0.4);
}

TEST_F(FloorCastTest, GrazingRaysKnowLittle) {
  ASSERT_TRUE(cast_ray(scene.map, towards({0.1, 4, 0.27}, {7.9, 4, 0.19}), hit));
  EXPECT_NEAR(hit.position_m.z(), 0.23, 0.015);
  EXPECT_GT(std::sqrt(hit.variance_m2), 0.1F);
  EXPECT_FALSE(cast_ray(scene.map, {{0.1, 4, 0.33}, Vector3d::UnitX(), 60}, hit));
}

TEST_F(FloorCastTest, BeyondTheRangeAndAwayNothingIsHit) {
  EXPECT_TRUE(cast_ray(scene.map, {{4, 4, 2.23}, -Vector3d::UnitZ(), 2.02}, hit));
  EXPECT_FALSE(cast_ray(scene.map, {{4, 4, 2.23}, -Vector3d::UnitZ(), 1.98}, hit));
  EXPECT_FALSE(cast_ray(scene.map, {{4, 4, 2.23}, Vector3d::UnitZ(), 60}, hit));
  EXPECT_FALSE(cast_ray(scene.map, {{4, 4, 0.0}, -Vector3d::UnitZ(), 60}, hit));  // the surface is behind
}

// Rays in the planes between cells and quads, and along their edges, find the floor as all others do.
TEST_F(FloorCastTest, RaysOnLatticeBordersMissNothing) {
  for (const double x : {0.5, 1.0, 3.1, 4.0})
    for (const double y : {0.5, 2.0, 4.2}) {
      EXPECT_TRUE(cast_ray(scene.map, {{x, y, 3}, -Vector3d::UnitZ(), 60}, hit)) << x << " " << y;
      EXPECT_NEAR(hit.distance_m, 2.77, 4e-3);
      EXPECT_TRUE(cast_ray(scene.map, towards({x, y, 3}, {x, 7, 0.23}), hit)) << x << " " << y;
    }
}

TEST_F(FloorCastTest, WhatIsNoRayIsRefused) {
  const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
  for (const Ray& ray :
       {Ray{{4, 4, 2}, {nan, 0, -1}, 60}, Ray{{4, nan, 2}, {0, 0, -1}, 60}, Ray{{4, 4, 2}, {0, 0, 0}, 60},
        Ray{{4, 4, 2}, {0, 0, -1}, nan}, Ray{{4, 4, 2}, {0, 0, -1}, infinite}, Ray{{4, 4, 1e12}, {0, 0, -1}, 60},
        Ray{{4, 4, 2}, {0, 0, -1}, -1}})
    EXPECT_FALSE(cast_ray(scene.map, ray, hit));
}

// A wall with a hole of 1 m x 1 m and another wall 3 m behind.
TEST_F(RayCastTest, SeesThroughHoles) {
  scene.add_patch({4, 0, 0}, {0, 2, 0}, {0, 0, 3});
  scene.add_patch({4, 3, 0}, {0, 2, 0}, {0, 0, 3});
  scene.add_patch({4, 2, 0}, {0, 1, 0}, {0, 0, 1});
  scene.add_patch({4, 2, 2}, {0, 1, 0}, {0, 0, 1});
  scene.add_patch({7, 0, 0}, {0, 5, 0}, {0, 0, 3});
  scene.fuse({0, 2.5F, 1.5F});
  ASSERT_TRUE(cast_ray(scene.map, towards({0, 2.5, 1.5}, {4, 2.5, 1.6}), hit));
  EXPECT_NEAR(hit.position_m.x(), 7, 5e-3);
  ASSERT_TRUE(cast_ray(scene.map, towards({0, 2.5, 1.5}, {4, 1.7, 1.6}), hit));
  EXPECT_NEAR(hit.position_m.x(), 4, 5e-3);
}

// From inside the nearest wall; a few rays into the corners, where layers of two walls overlap, are farther off.
TEST_F(RayCastTest, MeetsTheNearestOfABoxsWalls) {
  scene.add_room({0, 0, 0}, {6, 5, 3});
  scene.fuse({3, 2.5F, 1.5F});
  const Vector3d inside(2.2, 2.6, 1.4), low(0, 0, 0), high(6, 5, 3);
  std::uniform_real_distribution<double> any(-1, 1);
  int cast = 0, missed = 0, far = 0;
  while (cast < 2000) {
    const Vector3d d = Vector3d(any(scene.random), any(scene.random), any(scene.random)).normalized();
    double truth_m = 1e9;
    for (int i = 0; i < 3; ++i) truth_m = std::min(truth_m, ((d[i] > 0 ? high[i] : low[i]) - inside[i]) / d[i]);
    if (inside.z() + truth_m * d.z() > 2.9) continue;  // the room has no ceiling
    ++cast;
    const bool met = cast_ray(scene.map, {inside, d, 60}, hit);
    missed += !met;
    if (met) far += std::abs(hit.distance_m - truth_m) * std::abs(d.dot(hit.normal.cast<double>())) > 0.015;
  }
  RecordProperty("missed", missed);
  RecordProperty("far", far);
  EXPECT_LT(missed, 20);
  EXPECT_LT(far, 30);
}

TEST_F(RayCastTest, FromOutsideAWallIsMetFromItsBack) {
  scene.add_room({0, 0, 0}, {6, 5, 3});
  scene.fuse({3, 2.5F, 1.5F});
  ASSERT_TRUE(cast_ray(scene.map, towards({-4, 2.3, 1.6}, {0, 2.3, 1.6}), hit));
  EXPECT_NEAR(hit.distance_m, 4, 5e-3);
  EXPECT_FALSE(hit.front);
}

// Fine cells have stripes of the wall only; the coarse ones have it all. What lies between the stripes is hit, and said
// not to have been seen.
TEST_F(RayCastTest, CoarseCellsCloseWhatASparseLidarLeavesOpen) {
  for (int k = 0; k < 8; ++k)
    scene.add_patch({6.3F, 0, 0.45F * static_cast<float>(k) + 0.2F}, {0, 12, 0}, {0, 0, 0.05F}, 0.03F);
  scene.fuse({0, 6, 1.5F}, 3);
  int seen = 0, hits = 0;
  constexpr int kRays = 40;
  for (int k = 0; k < kRays; ++k) {
    if (!cast_ray(scene.map, towards({0, 6, 1.5}, {6.3, 5.03, 0.6 + 0.05 * k}), hit)) continue;
    ++hits;
    seen += hit.seen;
    EXPECT_NEAR(hit.position_m.x(), 6.3, 0.02);
  }
  EXPECT_GE(hits, 38);
  EXPECT_GT(seen, 2);
  EXPECT_LT(seen, 35);
}

// The extracted mesh, triangle by triangle, is what the layers' quads are: of 2,000 rays at walls, floor and a ramp.
TEST_F(RayCastTest, AgreesWithTheExtractedMesh) {
  scene.add_room({0, 0, 0}, {6, 5, 3});
  scene.add_patch({2, 2, 0.8F}, {1.2F, 0, 0.5F}, {0, 1.2F, 0});
  scene.fuse({3, 1, 2});
  test::OwnedArena arena(std::size_t{32} << 20);
  MeshExtraction extraction(scene.map.config(), {8000, 200'000, 100'000, 200'000, 50'000}, *arena);
  NoBeams none;
  const auto mesh = extraction.extract(scene.map.window(0), none);
  const Vector3d zero = scene.map.window(0).origin().cast<double>() * scene.map.config().cell_size_m;
  std::uniform_real_distribution<double> any(-1, 1);
  int both = 0, one = 0, far = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vector3d from(3 + 1.5 * any(scene.random), 1 + 0.5 * any(scene.random), 2 + 0.5 * any(scene.random));
    const Ray ray{from, Vector3d(any(scene.random), any(scene.random), any(scene.random)).normalized(), 30};
    const double expected_m = test::mesh_distance(ray, mesh, zero);
    const bool met = cast_ray(scene.map, ray, hit) && hit.seen;
    both += met && std::isfinite(expected_m);
    one += met != std::isfinite(expected_m);
    if (met && std::isfinite(expected_m)) {
      const double cosine = std::abs(hit.normal.cast<double>().dot(ray.direction));
      far += std::abs(hit.distance_m - expected_m) * std::max(cosine, 0.1) > 0.01;
    }
  }
  RecordProperty("both", both);
  RecordProperty("one_only", one);
  RecordProperty("apart", far);
  EXPECT_GT(both, 1200);
  EXPECT_LT(one, 40);
  EXPECT_LT(far, 30);
}

}  // namespace
}  // namespace lxd::mapping_ray_cast_test
