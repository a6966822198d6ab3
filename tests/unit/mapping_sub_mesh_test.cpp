// SPDX-License-Identifier: Apache-2.0
// A sub-mesh: what its layers make of points, how well they know it, and what happens when there is no room.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include "mapping/sub_mesh.hpp"
#include "rt/allocation_guard.hpp"
#include "tests/support/mapping_scene.hpp"

namespace lxd::mapping_sub_mesh_test {
namespace {

using test::MappingScene;
using Vec = Eigen::Vector3f;

// Nothing rests, so that every look counts.
MappingConfig restless() {
  MappingConfig config;
  config.converged_sigma_m = 0;
  return config;
}

const Layer& only_layer(const SubMesh& sub_mesh) {
  EXPECT_EQ(sub_mesh.layer_count(), 1U);
  return sub_mesh.layer(0);
}

TEST(SubMesh, RecoversANoiseFreePlaneWithinAMillimetre) {
  MappingScene scene(restless());
  scene.sigma_m = 1e-4F;
  scene.add_patch({0, 0, 0.1F}, {0.5F, 0, 0.1F}, {0, 0.5F, 0.05F});
  scene.fuse({0.2F, 0.2F, 2});
  const Layer& layer = only_layer(scene.sub_mesh);
  EXPECT_EQ(layer.axis, 2);
  EXPECT_EQ(layer.side, 1);
  EXPECT_EQ(layer.seen_quads, (1U << kLayerQuads) - 1);
  for (int i = 0; i < kLayerVertices; ++i) {
    const auto u = static_cast<float>(i % kVerticesPerEdge), v = static_cast<float>(i / kVerticesPerEdge);
    EXPECT_NEAR(layer.height_m[i], 0.1F + 0.02F * u + 0.01F * v, 1e-3F);
  }
}

// Paper, eq. of mu_new and sigma_new^2: of two equal looks the second halves the variance, but looks share their
// errors: never below one look's variance divided by independent_looks_max.
TEST(SubMesh, FusionHalvesTheVarianceDownToTheSharedPart) {
  MappingConfig config = restless();
  config.independent_looks_max = 4.0;
  MappingScene scene(config);
  const auto look = [&] {
    for (int i = 0; i < kLayerQuads; ++i)
      scene.add({0.05F + 0.1F * static_cast<float>(i % kQuadsPerEdge),
                 0.05F + 0.1F * static_cast<float>(i / kQuadsPerEdge), 0.25F});
    scene.fuse({0.2F, 0.2F, 2}, 1);
    return scene.sub_mesh.layer(0).variance_m2[14];
  };
  const float first = look(), second = look();
  EXPECT_NEAR(second, first / 2, 0.02F * first);
  EXPECT_NEAR(look(), first / 3, 0.02F * first);
  for (int i = 0; i < 20; ++i) look();
  EXPECT_NEAR(look(), first / 4, 0.02F * first);
  EXPECT_NEAR(scene.sub_mesh.layer(0).height_m[14], 0.25F, 1e-5F);
}

// Calibration: over many noisy planes the squared error of a vertex is what its variance says, within a factor: the
// kernel allows for roughness that a plane has not, so that the variance may be above, never much below.
TEST(SubMesh, VarianceCoversTheError) {
  double sum = 0, count = 0;
  for (unsigned seed = 0; seed < 60; ++seed) {
    MappingScene scene(restless());
    scene.random.seed(seed);
    scene.sigma_m = 0.02F;
    scene.add_patch({0, 0, 0.2F}, {0.5F, 0, 0}, {0, 0.5F, 0}, 0.05F);
    scene.fuse({0.2F, 0.2F, 2});
    for (std::uint32_t l = 0; l < scene.sub_mesh.layer_count(); ++l)
      for (int i = 0; i < kLayerVertices; ++i) {
        const double error = static_cast<double>(scene.sub_mesh.layer(l).height_m[i]) - 0.2;
        sum += error * error / static_cast<double>(scene.sub_mesh.layer(l).variance_m2[i]);
        ++count;
      }
  }
  EXPECT_GT(count, 60 * kLayerVertices * 0.9);
  EXPECT_LT(sum / count, 1.5);
  EXPECT_GT(sum / count, 0.1);
}

TEST(SubMesh, AWallIsALayerOverItsOwnAxis) {
  for (int axis = 0; axis < 3; ++axis) {
    MappingScene scene;
    Vec corner = Vec::Zero(), u = Vec::Zero(), v = Vec::Zero(), sensor = Vec::Constant(0.2F);
    corner[axis] = 0.3F;
    u[axis_u(axis)] = v[axis_v(axis)] = 0.5F;
    sensor[axis] = -3;
    scene.add_patch(corner, u, v);
    scene.fuse(sensor);
    EXPECT_EQ(only_layer(scene.sub_mesh).axis, axis);
    EXPECT_EQ(only_layer(scene.sub_mesh).side, -1);
  }
}

// Points that are on no surface yet are not lost: they wait, and make one when there are enough.
TEST(SubMesh, PointsWaitUntilTheyMakeALayer) {
  MappingConfig config;
  MappingScene scene(config);
  for (int i = 0; i < config.layer_points_min; ++i) {
    EXPECT_EQ(scene.sub_mesh.layer_count(), 0U);
    scene.add({0.05F + 0.1F * static_cast<float>(i % 4), 0.1F + 0.2F * static_cast<float>(i / 4), 0.25F});
    scene.fuse({0.2F, 0.2F, 2}, 1);
  }
  EXPECT_EQ(scene.sub_mesh.layer_count(), 1U);
}

TEST(SubMesh, SideIsAskedAgainAtEveryLook) {
  MappingScene scene(restless());
  scene.add_patch({0, 0, 0.25F}, {0.5F, 0, 0}, {0, 0.5F, 0});
  scene.fuse({0.2F, 0.2F, 2});
  EXPECT_EQ(scene.sub_mesh.layer(0).side, 1);
  scene.add_patch({0, 0, 0.25F}, {0.5F, 0, 0}, {0, 0.5F, 0});
  scene.fuse({0.2F, 0.2F, -2});
  EXPECT_EQ(scene.sub_mesh.layer(0).side, -1);
}

// A row of cells along x with one floor each.
void add_floors(MappingScene& scene, int first, int count) {
  scene.add_patch({0.5F * static_cast<float>(first), 0, 0.25F}, {0.5F * static_cast<float>(count), 0, 0}, {0, 0.5F, 0});
}

struct Room {
  std::uint32_t cells, layers;
  bool cells_full, layers_full;
};

class SubMeshCapacityLimit : public testing::TestWithParam<Room> {};

// Given room for four floors in four cells, or for one thing less or more; when the four come, then what found no room
// is counted; the floors that were there before stay as they were.
TEST_P(SubMeshCapacityLimit, IsCountedAndOldSurfacesStay) {
  const Room& room = GetParam();
  MappingScene scene({}, {room.cells, room.layers, 8, 10'000});
  add_floors(scene, 0, 1);
  scene.fuse({0.2F, 0.2F, 2});
  ASSERT_EQ(scene.sub_mesh.layer_count(), 1U);
  const auto heights = scene.sub_mesh.layer(0).height_m;
  add_floors(scene, 1, 3);
  scene.fuse({0.2F, 0.2F, 2});
  const SubMeshCounters& counters = scene.sub_mesh.counters();
  EXPECT_EQ(counters.cells_full > 0, room.cells_full);
  EXPECT_EQ(counters.layers_full > 0, room.layers_full);
  EXPECT_EQ(scene.sub_mesh.layer(0).height_m, heights);
  EXPECT_LE(scene.sub_mesh.fill(), 1.0);
}

INSTANTIATE_TEST_SUITE_P(BelowAtAbove, SubMeshCapacityLimit,
                         testing::Values(Room{3, 4, true, false}, Room{4, 4, false, false}, Room{5, 5, false, false},
                                         Room{4, 3, false, true}));

// Four points in each of three cells, too few for a layer: every cell wants a block to let them wait in.
TEST(SubMesh, WaitingPointsWithoutABlockAreCounted) {
  for (const auto& [blocks, lost] : {std::pair{2U, 4U}, {3U, 0U}, {4U, 0U}}) {
    MappingScene scene({}, {8, 8, blocks, 100});
    for (int i = 0; i < 12; ++i)
      scene.add({0.1F + 0.5F * static_cast<float>(i / 4), 0.1F * static_cast<float>(i % 4), 0.25F});
    scene.fuse({0.2F, 0.2F, 2}, 1);
    EXPECT_EQ(scene.sub_mesh.counters().waiting_full, lost);
    EXPECT_EQ(scene.sub_mesh.cells().size(), 3U);
  }
}

// Given a cell whose few points keep the only block, when the LiDAR has not seen it for long enough, then the block
// goes to a cell in view, which makes its layer.
TEST(SubMesh, BlockOfACellOutOfViewGoesToOneInView) {
  for (const std::uint32_t rest : {WaitingPool::kStaleSweeps - 1, WaitingPool::kStaleSweeps}) {
    MappingScene scene({}, {8, 8, 1, 1000});
    for (int i = 0; i < 4; ++i) scene.add({0.1F, 0.1F * static_cast<float>(i), 0.25F});
    scene.fuse({0.2F, 0.2F, 2}, 1);
    for (std::uint32_t i = 0; i < rest; ++i) scene.fuse({0.2F, 0.2F, 2}, 0);
    scene.add_patch({1, 1, 0.25F}, {0.5F, 0, 0}, {0, 0.5F, 0});
    scene.fuse({1.2F, 1.2F, 2}, 1);
    const bool stale = rest == WaitingPool::kStaleSweeps;
    EXPECT_EQ(scene.sub_mesh.layer_count(), stale ? 1U : 0U) << rest;
    EXPECT_EQ(scene.sub_mesh.counters().waiting_full > 0, !stale) << rest;
  }
}

// reset() touches no cell: a sub-mesh of a million slots is emptied as often as one likes.
TEST(SubMesh, ResetEmptiesItAndIsFreeOfItsSize) {
  MappingScene scene;
  for (int round = 0; round < 20'000; ++round) {
    scene.sub_mesh.reset({0.7, -0.2, 0}, RigTime::from_ns(round));
    ASSERT_EQ(scene.sub_mesh.cells().size(), 0U);
  }
  EXPECT_EQ(scene.sub_mesh.origin(), CellIndex(1, -1, 0));
  add_floors(scene, 0, 2);
  scene.fuse({0.2F, 0.2F, 2});
  EXPECT_EQ(scene.sub_mesh.layer_count(), 2U);
  scene.sub_mesh.reset(Eigen::Vector3d::Zero(), RigTime::from_ns(1));
  EXPECT_EQ(scene.sub_mesh.find({0, 0, 0}), kNone);
  EXPECT_EQ(scene.sub_mesh.layer_count(), 0U);
  EXPECT_EQ(scene.sub_mesh.counters().regressions, 0U);
}

TEST(SubMeshRealTime, InsertAllocatesNothing) {
  MappingScene scene;
  std::array<MapPoint, 4000> points;
  for (int i = 0; i < 4000; ++i)
    points[i] = {{static_cast<float>(i % 80) * 0.03F, static_cast<float>(i / 80) * 0.03F, 0.2F}, 1e-4F};
  const AllocationGuard guard;
  for (std::uint32_t sweep = 0; sweep < 5; ++sweep)
    scene.sub_mesh.insert(points, Eigen::Vector3d::Zero(), {1, 1, 2}, sweep);
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_GT(scene.sub_mesh.layer_count(), 0U);
}

}  // namespace
}  // namespace lxd::mapping_sub_mesh_test
