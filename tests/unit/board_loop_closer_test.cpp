// SPDX-License-Identifier: Apache-2.0
// Key frames wait for their sub-mesh to be finished, and go to the loop finder with it.
#include <gtest/gtest.h>

#include "board/loop_closer.hpp"

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

}  // namespace
}  // namespace lxd::board_loop_closer_test
