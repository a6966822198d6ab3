// SPDX-License-Identifier: Apache-2.0
// Key frames wait for their sub-mesh to be finished, and go to the loop finder with it.
#include <gtest/gtest.h>

#include "board/loop_closer.hpp"
#include "tests/support/sight_scene.hpp"

namespace lxd::board_loop_closer_test {
namespace {

KeyFrame frame(std::int64_t id, std::int64_t sub_mesh) {
  KeyFrame key_frame;
  key_frame.id = id;
  key_frame.sub_mesh = sub_mesh;
  key_frame.T_world_body.p = {10.0 * static_cast<double>(id), 0, 1};
  key_frame.travelled_m = id == 0 ? 0 : 10;
  return key_frame;
}

// A patch of floor under the place.
std::vector<MeshVertex> floor_around(double x_m) {
  std::vector<MeshVertex> vertices;
  for (int i = -40; i < 40; ++i)
    for (int j = -40; j < 40; ++j) {
      MeshVertex vertex{};
      vertex.position_m = {static_cast<float>(x_m + 0.2 * i), 0.2F * static_cast<float>(j), 0};
      vertex.normal = {0, 0, 1};
      vertex.variance_m2 = 1e-5F;
      vertices.push_back(vertex);
    }
  return vertices;
}

TEST(LoopCloser, KeyFramesGoWithTheirSubMesh) {
  LoopCloser closer;
  for (std::int64_t id = 0; id < 6; ++id) closer.note(frame(id, id / 2));
  for (std::int64_t id = 0; id < 3; ++id) {
    EXPECT_EQ(closer.counters().places, static_cast<std::uint64_t>(2 * id));
    const auto vertices = floor_around(20.0 * static_cast<double>(id));
    EXPECT_TRUE(closer.close(id, {id, Pose(), vertices}).loops.empty());  // a path that goes straight on closes nothing
  }
  EXPECT_EQ(closer.counters().places, 6U);
}

TEST(LoopCloser, ASubMeshWithoutKeyFramesIsNoPlace) {
  LoopCloser closer;
  closer.note(frame(0, 1));
  EXPECT_TRUE(closer.close(0, {}).loops.empty());
  EXPECT_EQ(closer.counters().places, 0U);
}

// Given places that a camera has seen, then one that is seen again closes with the key frame of the graph's number; and
// after the filter began again it is a place in what is finished by then.
TEST(LoopCloser, WhatIsSeenAgainCloses) {
  LoopCloser closer(/*by_surfaces=*/false);
  constexpr std::int64_t kSeen = 20;
  for (std::int64_t id = 0; id < kSeen; ++id) {
    closer.note(frame(id, id / 4));
    VisualKeyFrame seen = test::SightScene({}, static_cast<unsigned>(id)).historical;
    seen.id = id;
    EXPECT_TRUE(closer.look(seen).loops.empty());
  }
  const test::SightScene again({}, 3);
  KeyFrame back = frame(kSeen, 5);
  back.T_world_body = frame(3, 0).T_world_body * again.T_from_to();
  closer.note(back);
  VisualKeyFrame seen = again.current;
  seen.id = kSeen;
  const auto closed = closer.look(seen);
  ASSERT_EQ(closed.loops.size(), 1U);
  EXPECT_EQ(closed.loops[0].from, 3);
  EXPECT_EQ(closed.loops[0].to, kSeen);

  PoseGraph solved{GraphConfig{}};
  constexpr int kMap = 1;
  closer.begin_again(solved, kMap);
  closer.note(frame(0, 0));
  seen.id = 0;
  const auto found = closer.look(seen);
  ASSERT_EQ(found.places.size(), 1U);
  EXPECT_EQ(found.places[0].map, kMap);
  EXPECT_EQ(found.places[0].key_frame, 0);
  EXPECT_LT((found.places[0].T_map_body.p - back.T_world_body.p).norm(), 0.3);
}

}  // namespace
}  // namespace lxd::board_loop_closer_test
