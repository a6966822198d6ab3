// SPDX-License-Identifier: Apache-2.0
// What lies between key frames goes with them: poses, sub-meshes, the cloud; and T_map_world does not leap.
#include <gtest/gtest.h>

#include "backend/cloud.hpp"
#include "backend/graph/corrected_path.hpp"
#include "backend/graph/smooth_correction.hpp"
#include "tests/support/graph_story.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::backend_corrected_path_test {
namespace {

using test::GraphStory;

// Two rounds of 400 m that loops have closed.
struct Closed {
  GraphStory story;
  PoseGraph graph{GraphConfig{}};
  CorrectedPath path;

  Closed() {
    story.drive(test::ring(400, 2, 4), {});
    for (const KeyFrame& frame : story.key_frames) {
      graph.add(frame);
      path.note_sub_mesh(frame.stamp, frame.sub_mesh);
      if (frame.id > 100 && frame.id % 5 == 0)
        graph.add(story.loop(static_cast<int>(frame.id) - 100, static_cast<int>(frame.id)));
    }
    graph.finish();
    path.add(graph);
  }
};

TEST(CorrectedPath, KeyFramesAreWhereTheGraphHasThemAndOthersBetween) {
  const Closed closed;
  ASSERT_TRUE(closed.path.moved());
  for (int i = 1; i < closed.graph.size(); i += 7) {
    const KeyFrame &before = closed.graph.key_frame(i - 1), &frame = closed.graph.key_frame(i);
    EXPECT_LT((closed.path.correct(frame.stamp, frame.T_world_body).p - closed.graph.T_map_body(i).p).norm(), 1e-9);
    const RigTime middle = before.stamp + (frame.stamp - before.stamp) / 2;
    const Pose T = blend(before.T_world_body, frame.T_world_body, 0.5);
    const Pose wanted = blend(closed.graph.T_map_body(i - 1), closed.graph.T_map_body(i), 0.5);
    EXPECT_LT((closed.path.correct(middle, T).p - wanted.p).norm(), 1e-3);
  }
}

TEST(CorrectedPath, WithoutAGraphThatMovesEveryBitStays) {
  GraphStory story;
  story.drive(test::ring(400, 1, 4), {});
  PoseGraph graph({});
  for (const KeyFrame& frame : story.key_frames) graph.add(frame);
  graph.finish();
  CorrectedPath path;
  path.add(graph);
  EXPECT_FALSE(path.moved());
  const Pose T = story.key_frames[37].T_world_body;
  EXPECT_EQ(path.correct(story.key_frames[37].stamp, T).p, T.p);
}

TEST(CorrectedPath, SubMeshesAreFoundByTheirFirstSweep) {
  const Closed closed;
  const KeyFrame& frame = closed.graph.key_frame(150);
  const auto T_map_world = closed.path.sub_mesh(frame.stamp);
  ASSERT_TRUE(T_map_world);
  EXPECT_LT(((*T_map_world * frame.T_world_body).p - closed.graph.T_map_body(150).p).norm(), 0.1);
  EXPECT_FALSE(closed.path.sub_mesh(frame.stamp + Duration::from_ns(1)));
}

// Each has a world of its own: nothing is blended from one into the other.
TEST(CorrectedPath, ASecondGraphHasNoPartInTheFirst) {
  Closed closed;
  GraphStory later;
  later.drive(test::ring(400, 0.2, 4), {});
  PoseGraph graph({});
  const Duration shift = Duration::from_seconds(1000);
  for (KeyFrame frame : later.key_frames) {
    frame.stamp = frame.stamp + shift;
    graph.add(frame);
  }
  graph.finish();
  closed.path.add(graph);
  const KeyFrame& last = closed.graph.key_frame(closed.graph.size() - 1);
  const Pose after = closed.path.correct(last.stamp + Duration::from_seconds(1), last.T_world_body);
  EXPECT_LT((after.p - closed.graph.T_map_body(closed.graph.size() - 1).p).norm(), 1e-9);
  const Pose T = later.key_frames[3].T_world_body;
  EXPECT_LT((closed.path.correct(later.key_frames[3].stamp + shift, T).p - T.p).norm(), 1e-12);
}

TEST(SmoothCorrection, FollowsALeapWithinItsTimeWithoutOne) {
  SmoothCorrection smooth(1.0);
  const Pose body{Exp(Eigen::Vector3d(0, 0, 1)), {500, 20, 0}};
  const Pose leap{Exp(Eigen::Vector3d(0, 0, 0.002)), {0.5, -0.3, 0}};
  RigTime t = RigTime::from_seconds(10);
  smooth.step(t, body, Pose());
  Eigen::Vector3d last = body.p;
  for (int i = 0; i < 50; ++i) {
    t = t + Duration::from_seconds(0.1);
    const Eigen::Vector3d p = (smooth.step(t, body, leap).T_map_world * body).p;
    EXPECT_LT((p - last).norm(), 0.11 * (leap * body.p - body.p).norm());
    last = p;
  }
  EXPECT_LT((last - leap * body.p).norm(), 0.01 * (leap * body.p - body.p).norm());
}

TEST(MovedCloud, EveryPointGoesWithItsSweep) {
  const test::TemporaryFolder folder;
  const auto file = folder / "cloud.ply";
  auto writer = CloudWriter::create(file);
  ASSERT_TRUE(writer.ok());
  std::vector<StampedPose> from, to;
  std::vector<CloudPoint> points;
  for (int i = 0; i < 5; ++i) {
    const RigTime stamp = RigTime::from_seconds(1'700'000'000 + 0.1 * i);
    from.push_back({stamp, {Eigen::Matrix3d::Identity(), {1.0 * i, 0, 0}}});
    to.push_back({stamp, {Eigen::Matrix3d::Identity(), {1.0 * i, 0.5 * i, 0}}});
    points.push_back({10, 0, 0, 1, stamp.seconds()});
  }
  ASSERT_TRUE(writer->append(points));
  ASSERT_TRUE(writer->close());
  ASSERT_TRUE(move_cloud(file, from, to));
  auto reader = CloudReader::open(file);
  ASSERT_TRUE(reader.ok());
  ASSERT_EQ(reader->size(), 5u);
  const Status read = reader->for_each_chunk([](std::span<const CloudPoint> chunk) {
    for (std::size_t i = 0; i < chunk.size(); ++i) {
      EXPECT_FLOAT_EQ(chunk[i].x_m, 10);
      EXPECT_NEAR(chunk[i].y_m, 0.5 * static_cast<double>(i), 1e-5);
    }
    return success();
  });
  EXPECT_TRUE(read);
}

}  // namespace
}  // namespace lxd::backend_corrected_path_test
