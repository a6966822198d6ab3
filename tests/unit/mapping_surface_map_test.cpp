// SPDX-License-Identifier: Apache-2.0
// The ring of sub-meshes: its window, who retires and when, and which surface answers a query.
#include <vector>

#include <gtest/gtest.h>

#include "mapping/surface_map.hpp"
#include "tests/support/mapping_scene.hpp"

namespace lxd::mapping_surface_map_test {
namespace {

constexpr SubMeshCapacity kSmall{500, 500, 200, 20'000};

class SurfaceMapTest : public testing::Test {
 protected:
  SurfaceMapTest() : arena_(std::size_t{32} << 20), map_(config(), {kSmall, kSmall}, *arena_) {}

  static MappingConfig config() {
    MappingConfig c;
    c.submesh_path_m = 10.0;
    return c;
  }

  // One sweep of the LiDAR at x, 2 m high; `points` in the world.
  void sweep_at(double x_m, const std::vector<MapPoint>& points = {}, const std::vector<MapPoint>& thinned = {}) {
    map_.insert(
        {points, thinned, Eigen::Vector3d::Zero(), {static_cast<float>(x_m), 0, 2}, RigTime::from_ns(++stamp_)});
  }

  static std::vector<MapPoint> floor(float height_m, float size_m, float step_m, float variance_m2 = 1e-4F) {
    std::vector<MapPoint> points;
    for (float x = step_m / 2; x < size_m; x += step_m)
      for (float y = step_m / 2; y < size_m; y += step_m) points.push_back({{x, y, height_m}, variance_m2});
    return points;
  }

  test::OwnedArena arena_;
  SurfaceMap map_;
  std::int64_t stamp_ = 0;
};

TEST_F(SurfaceMapTest, IsEmptyAtFirstAndAfterClear) {
  SurfaceHit hit{};
  EXPECT_TRUE(map_.empty());
  EXPECT_FALSE(map_.nearest({0, 0, 0}, hit));
  sweep_at(0, floor(0.25F, 1, 0.04F));
  EXPECT_TRUE(map_.nearest({0.5, 0.5, 0.3}, hit));
  map_.clear();
  EXPECT_TRUE(map_.empty());
  EXPECT_FALSE(map_.nearest({0.5, 0.5, 0.3}, hit));
}

// Given a carrier and a question beyond the lattice; then there is no surface, and its points are counted as lost.
TEST_F(SurfaceMapTest, BeyondTheLatticeIsNothing) {
  SurfaceHit hit{};
  const std::vector<MapPoint> points = floor(0.25F, 1, 0.04F);
  map_.insert({points, points, {1e12, 0, 0}, {0, 0, 2}, RigTime::from_ns(1)});
  EXPECT_EQ(map_.window(0).counters().cells_full, points.size());
  EXPECT_EQ(map_.window(0).layer_count(), 0U);
  for (const double far : {6e5, 1e12, 1e300}) EXPECT_FALSE(map_.nearest({far, 0.5, 0.25}, hit)) << far;
}

// Given a sub-mesh every 10 m and a window of three; then the fourth sends the first into retirement, and so on in
// order; one that nobody collected in time is lost and counted.
TEST_F(SurfaceMapTest, RetiresTheOldestAndCountsWhatNobodyCollected) {
  for (int k = 0; k <= 2; ++k) sweep_at(10.0 * k);
  EXPECT_EQ(map_.window_size(), 3U);
  EXPECT_EQ(map_.retired(), nullptr);
  for (int k = 3; k <= 5; ++k) {
    sweep_at(10.0 * k);
    ASSERT_NE(map_.retired(), nullptr);
    EXPECT_EQ(map_.retired()->begin(), RigTime::from_ns(k - 2));
    EXPECT_EQ(map_.window(0).begin(), RigTime::from_ns(k - 1));
    EXPECT_EQ(map_.window_size(), 3U);
    map_.release_retired();
    EXPECT_EQ(map_.retired(), nullptr);
  }
  EXPECT_EQ(map_.lost_sub_meshes(), 0U);
  sweep_at(60);
  sweep_at(70);
  EXPECT_EQ(map_.lost_sub_meshes(), 1U);
}

// Given one that waits, as somebody may be reading it, when others leave the window, then it stays as it is, the window
// goes on in order, and after its release the next one retires again.
TEST_F(SurfaceMapTest, WhatWaitsStaysAsItIsHoweverManyLeaveMeanwhile) {
  sweep_at(0, floor(0.25F, 2, 0.04F));
  for (int k = 1; k <= 3; ++k) sweep_at(10.0 * k);
  const SubMesh* const waiting = map_.retired();
  ASSERT_NE(waiting, nullptr);
  const std::uint32_t layers = waiting->layer_count();
  ASSERT_GT(layers, 0U);
  for (int k = 4; k <= 12; ++k) {
    sweep_at(10.0 * k, floor(0.25F, 1, 0.04F));
    EXPECT_EQ(map_.retired(), waiting);
    EXPECT_EQ(waiting->begin(), RigTime::from_ns(1));
    EXPECT_EQ(waiting->layer_count(), layers);
    for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(map_.window(i).begin(), RigTime::from_ns(k - 1 + i)) << k;
  }
  EXPECT_EQ(map_.lost_sub_meshes(), 9U);
  map_.release_retired();
  sweep_at(130);
  ASSERT_NE(map_.retired(), nullptr);
  EXPECT_EQ(map_.retired()->begin(), RigTime::from_ns(11));
}

TEST_F(SurfaceMapTest, BeginsANewOneWhenTheYoungestIsFull) {
  sweep_at(0, floor(0.25F, 20, 0.2F));  // 1,600 cells for 500
  sweep_at(0);
  EXPECT_EQ(map_.window_size(), 2U);
  EXPECT_GT(map_.window(0).counters().cells_full, 0U);
}

TEST_F(SurfaceMapTest, DistanceIsSignedAlongTheNormal) {
  sweep_at(0, floor(0.25F, 1, 0.04F));
  for (const double dz : {-0.05, 0.02, 0.2}) {
    SurfaceHit hit{};
    ASSERT_TRUE(map_.nearest({0.3, 0.6, 0.25 + dz}, hit));
    EXPECT_NEAR(hit.distance_m * hit.normal.z(), dz, 1e-3);
    EXPECT_NEAR(std::abs(hit.normal.z()), 1.0F, 1e-3F);
    EXPECT_GT(hit.variance_m2, 0);
  }
}

// A point in the empty cell above the floor's still finds the floor; one a cell's edge away finds nothing there.
TEST_F(SurfaceMapTest, NeighbourCellsAnswerForEmptyOnes) {
  sweep_at(0, floor(0.45F, 1, 0.04F));
  SurfaceHit hit{};
  ASSERT_TRUE(map_.nearest({0.3, 0.3, 0.6}, hit));
  EXPECT_NEAR(std::abs(hit.distance_m), 0.15, 1e-3);
  EXPECT_FALSE(map_.nearest({0.3, 0.3, 1.2}, hit));
  EXPECT_FALSE(map_.nearest({0.3, 0.3, -0.6}, hit));
}

// Given a wall of 20 cm whose two sides share a cell, and a return midway, then it belongs to the side that its beam
// met; where only the one side is known, the other has no surface.
TEST_F(SurfaceMapTest, AWallHasTwoSides) {
  const auto side = [](float x_m) {
    std::vector<MapPoint> points;
    for (float y = 0.02F; y < 1; y += 0.04F)
      for (float z = 0.02F; z < 1; z += 0.04F) points.push_back({{x_m, y, z}, 1e-4F});
    return points;
  };
  const Eigen::Vector3f forth = Eigen::Vector3f::UnitX(), back = -forth;
  SurfaceHit hit{};
  sweep_at(-3, side(0.14F));
  ASSERT_TRUE(map_.nearest({0.24, 0.3, 0.3}, hit, forth));
  EXPECT_NEAR(std::abs(hit.distance_m), 0.10, 1e-3);
  EXPECT_FALSE(map_.nearest({0.24, 0.3, 0.3}, hit, back));

  sweep_at(3, side(0.34F));
  ASSERT_TRUE(map_.nearest({0.20, 0.3, 0.3}, hit, back));
  EXPECT_NEAR(std::abs(hit.distance_m), 0.14, 1e-3) << "the nearer side looks away";
  ASSERT_TRUE(map_.nearest({0.28, 0.3, 0.3}, hit, forth));
  EXPECT_NEAR(std::abs(hit.distance_m), 0.14, 1e-3);
}

// The oldest surface has the least drift: it answers although a younger sub-mesh has another one there.
TEST_F(SurfaceMapTest, TheOldestKnownSurfaceAnswers) {
  for (int i = 0; i < 5; ++i) sweep_at(0, floor(0.25F, 1, 0.04F));
  for (int i = 0; i < 5; ++i) sweep_at(10, floor(0.30F, 1, 0.04F));
  ASSERT_EQ(map_.window_size(), 2U);
  SurfaceHit hit{};
  ASSERT_TRUE(map_.nearest({0.3, 0.3, 0.25}, hit));
  EXPECT_NEAR(hit.distance_m, 0.0, 2e-3);
}

// Fine cells answer first; where they have nothing, the coarse ones do.
TEST_F(SurfaceMapTest, CoarseCellsAnswerWhereFineOnesHaveNothing) {
  sweep_at(0, floor(0.25F, 1, 0.04F), floor(0.40F, 5, 0.25F));
  SurfaceHit hit{};
  ASSERT_TRUE(map_.nearest({0.3, 0.3, 0.25}, hit));
  EXPECT_NEAR(hit.distance_m, 0.0, 2e-3);
  ASSERT_TRUE(map_.nearest({4.2, 4.2, 0.40}, hit));
  EXPECT_NEAR(hit.distance_m, 0.0, 2e-3);
}

}  // namespace
}  // namespace lxd::mapping_surface_map_test
