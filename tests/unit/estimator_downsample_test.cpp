// SPDX-License-Identifier: Apache-2.0
// Thinning: by space and not by index, bounded, and an edge that finds the wanted number of points.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/downsample.hpp"
#include "mapping/lattice.hpp"
#include "tests/support/room_sweeps.hpp"

namespace lxd::estimator_downsample_test {
namespace {

using test::OwnedOdometry;
using test::RoomSweeps;

constexpr std::uint32_t kSlots = 64;
constexpr std::uint32_t kSlotsUsable = kSlots * 3 / 4;

class EstimatorDownsample : public testing::Test {
 protected:
  std::array<VoxelSet::Slot, kSlots> slots_;
  VoxelSet voxels_{slots_};
};

TEST_F(EstimatorDownsample, AVoxelIsTakenOnce) {
  EXPECT_TRUE(voxels_.insert(17));
  EXPECT_FALSE(voxels_.insert(17));
  EXPECT_TRUE(voxels_.insert(18));
  EXPECT_EQ(voxels_.count(), 2U);
}

TEST_F(EstimatorDownsample, ClearForgetsAll) {
  for (int round = 0; round < 1000; ++round) {
    for (std::uint64_t key = 0; key < 10; ++key) ASSERT_TRUE(voxels_.insert(key)) << round;
    voxels_.clear();
    ASSERT_EQ(voxels_.count(), 0U);
  }
}

TEST_F(EstimatorDownsample, TheKeyZeroIsAKeyLikeAnyOther) {
  EXPECT_TRUE(voxels_.insert(0));
  EXPECT_FALSE(voxels_.insert(0));
}

TEST_F(EstimatorDownsample, ItTakesThreeQuartersOfItsSlotsAndNoMore) {
  for (std::uint64_t key = 0; key < kSlotsUsable - 1; ++key) ASSERT_TRUE(voxels_.insert(key * 977));
  EXPECT_TRUE(voxels_.insert(1'000'001));   // at capacity
  EXPECT_FALSE(voxels_.insert(1'000'002));  // above
  EXPECT_FALSE(voxels_.insert(977));        // what is in is still known
  EXPECT_EQ(voxels_.count(), kSlotsUsable);
}

TEST(EstimatorVoxelEdge, AsManyPointsAsWantedKeepTheEdge) { EXPECT_EQ(next_voxel_edge(0.5, 2500, 2500), 0.5); }

TEST(EstimatorVoxelEdge, TwiceAsManyPointsOfSurfacesWantAnEdgeLargerBySqrtTwo) {
  EXPECT_NEAR(next_voxel_edge(0.5, 5000, 2500), 0.5 * std::sqrt(2.0), 1e-12);
  EXPECT_NEAR(next_voxel_edge(0.5, 1250, 2500), 0.5 / std::sqrt(2.0), 1e-12);
}

TEST(EstimatorVoxelEdge, StepAndEdgeAreBounded) {
  EXPECT_EQ(next_voxel_edge(1.0, 1'000'000, 2500), 1.5);
  EXPECT_EQ(next_voxel_edge(1.5, 0, 2500), 1.0);
  EXPECT_EQ(next_voxel_edge(2.9, 1'000'000, 2500), 3.0);
  EXPECT_EQ(next_voxel_edge(0.06, 0, 2500), 0.05);
}

TEST(EstimatorVoxelEdge, WideningEndsAtTheLargestEdge) {
  double edge = 0.05;
  for (int i = 0; i < 12; ++i) edge = wider_voxel_edge(edge);
  EXPECT_EQ(edge, kVoxelEdgeMax_m);
}

TEST(EstimatorVoxelEdge, OnASurfaceItFindsTheWantedNumber) {
  for (const double area_m2 : {20.0, 300.0, 5000.0}) {
    double edge = 0.5;
    const auto count = [&] { return static_cast<std::uint32_t>(area_m2 / (edge * edge)); };
    for (int sweep = 0; sweep < 10; ++sweep) edge = next_voxel_edge(edge, count(), 2500);
    EXPECT_NEAR(count(), 2500, 25) << area_m2;
  }
}

// The voxels of the odometry's thinned cloud; after the first sweep it lies in the LiDAR's own frame at the edge that
// thinning begins with.
constexpr double kFirstEdge_m = 0.5;
using Voxel = std::tuple<int, int, int>;

std::vector<Eigen::Vector3f> thinned(const std::vector<LidarPoint>& points,
                                     const OdometrySetup& setup = test::small_setup()) {
  RoomSweeps sweeps;
  OwnedOdometry odometry(setup);
  std::vector<Eigen::Vector3f> out;
  for (const RegisteredPoint& p : odometry->step(sweeps.with_points(points, 0)).registered) out.push_back(p.position_m);
  return out;
}

std::set<Voxel> voxels_of(const std::vector<Eigen::Vector3f>& points) {
  std::set<Voxel> out;
  for (const Eigen::Vector3f& p : points) {
    const Eigen::Vector3i i = (p / static_cast<float>(kFirstEdge_m)).array().floor().cast<int>();
    out.emplace(i.x(), i.y(), i.z());
  }
  return out;
}

std::vector<LidarPoint> room_points() {
  RoomSweeps sweeps;
  sweeps.next(State{}, 0);
  return sweeps.points();
}

TEST(EstimatorThinning, OneReturnAVoxel) {
  const auto points = thinned(room_points());
  EXPECT_GT(points.size(), 300U);
  EXPECT_EQ(voxels_of(points).size(), points.size());
}

TEST(EstimatorThinning, TheOrderOfThePointsDoesNotChangeTheVoxels) {
  auto points = room_points();
  const auto wanted = voxels_of(thinned(points));
  std::mt19937 random(61);
  for (int i = 0; i < 5; ++i) {
    std::shuffle(points.begin(), points.end(), random);
    EXPECT_EQ(voxels_of(thinned(points)), wanted) << i;
  }
}

TEST(EstimatorThinning, TheSamePointsGiveTheSameBits) {
  const auto points = room_points();
  EXPECT_EQ(thinned(points), thinned(points));
}

TEST(EstimatorThinning, ReturnsThatAreNoNumbersTooNearOrTooFarStayOut) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  auto points = room_points();
  const std::size_t wanted = thinned(points).size();
  for (const LidarPoint& bad : {LidarPoint{nan, 1, 1, 1, 0}, LidarPoint{1, nan, 1, 1, 0}, LidarPoint{1, 1, nan, 1, 0},
                                LidarPoint{inf, 1, 1, 1, 0}, LidarPoint{1, -inf, inf, 1, 0}, LidarPoint{0, 0, 0, 1, 0},
                                LidarPoint{0.1F, 0.2F, 0.1F, 1, 0}, LidarPoint{119, 119, 0, 1, 0}})
    points.insert(points.begin(), bad);
  const auto kept = thinned(points);
  EXPECT_EQ(kept.size(), wanted);
  for (const Eigen::Vector3f& p : kept) EXPECT_TRUE(p.allFinite());
}

// Points that each have a voxel of their own, twice over.
std::vector<LidarPoint> lonely_points(int count) {
  std::vector<LidarPoint> points;
  for (int i = 0; i < count; ++i)
    points.push_back({2.25F + 0.5F * static_cast<float>(i % 10), 2.25F + 0.5F * static_cast<float>(i / 10), 1, 1, 0});
  auto twice = points;
  twice.insert(twice.end(), points.begin(), points.end());
  return twice;
}

TEST(EstimatorThinning, BelowAtAndAboveTheCapacity) {
  OdometrySetup setup = test::small_setup();
  setup.registration_capacity = 100;
  EXPECT_EQ(thinned(lonely_points(99), setup).size(), 99U);
  EXPECT_EQ(thinned(lonely_points(100), setup).size(), 100U);
  for (const int above : {101, 300}) {  // thinned again with wider voxels
    const std::size_t count = thinned(lonely_points(above), setup).size();
    EXPECT_LE(count, 100U);
    EXPECT_GT(count, 30U);
  }
}

// Which points take part must not hang on their order, not even when there are too many for the capacity.
TEST(EstimatorThinning, AboveTheCapacityThePointsStillComeFromEverywhere) {
  OdometrySetup setup = test::small_setup();
  setup.registration_capacity = 100;
  double farthest = 0;
  for (const Eigen::Vector3f& p : thinned(lonely_points(300), setup)) farthest = std::max<double>(farthest, p.y());
  EXPECT_GT(farthest, 2.25 + 0.5 * 25);  // of 30 rows
}

}  // namespace
}  // namespace lxd::estimator_downsample_test
