// SPDX-License-Identifier: Apache-2.0
// The graph on drives whose truth is known: loops close it, false loops do not bend it, and without either it is
// odometry.
#include <gtest/gtest.h>

#include "tests/support/graph_story.hpp"

namespace lxd::backend_pose_graph_test {
namespace {

using test::GraphStory;

// Two rounds of 600 m; from the second on, a loop with the first at every fourth key frame.
GraphStory two_rounds(const GraphConfig& config) {
  GraphStory story;
  story.drive(test::ring(600, 2, 4), config);
  return story;
}

constexpr int kRound = 150;  // key frames

void play(GraphStory& story, PoseGraph& graph, bool with_loops) {
  for (const KeyFrame& frame : story.key_frames) {
    graph.add(frame);
    const auto i = static_cast<int>(frame.id);
    if (with_loops && i >= kRound && i % 4 == 0) graph.add(story.loop(i - kRound, i));
    graph.update();
  }
}

TEST(PoseGraph, WithoutLoopsAndFixesItIsOdometryToTheLastBit) {
  GraphStory story = two_rounds({});
  PoseGraph graph({});
  play(story, graph, false);
  graph.finish();
  EXPECT_FALSE(graph.constrained());
  for (int i = 0; i < graph.size(); ++i) {
    ASSERT_EQ(graph.T_map_body(i).p, story.key_frames[static_cast<std::size_t>(i)].T_world_body.p);
    ASSERT_EQ(graph.T_map_body(i).R, story.key_frames[static_cast<std::size_t>(i)].T_world_body.R);
  }
  EXPECT_EQ(graph.T_map_world().p, Eigen::Vector3d::Zero());
  EXPECT_EQ(graph.work().whole + graph.work().sub_meshes + graph.work().windows, 0u);
}

TEST(PoseGraph, LoopsTakeTheDriftOutOfARing) {
  GraphStory story = two_rounds({});
  PoseGraph odometry({}), graph({});
  play(story, odometry, false);
  play(story, graph, true);
  graph.finish();
  const double before_m = test::aligned_error_m(story.truth, odometry);
  const double after_m = test::aligned_error_m(story.truth, graph);
  EXPECT_GT(before_m, 0.3);
  EXPECT_LT(after_m, 0.3 * before_m);
  EXPECT_EQ(graph.loop_counts().accepted, graph.loop_counts().proposed);
}

TEST(PoseGraph, TheSameCallsGiveTheSameBits) {
  const auto run = [] {
    GraphStory story = two_rounds({});
    auto graph = std::make_unique<PoseGraph>(GraphConfig{});
    play(story, *graph, true);
    graph->finish();
    return graph;
  };
  const auto a = run(), b = run();
  for (int i = 0; i < a->size(); ++i) ASSERT_EQ(a->T_map_body(i).p, b->T_map_body(i).p);
}

TEST(PoseGraph, FalseLoopsAreLeftOutByTheirInconsistency) {
  // given true loops, and with every third of them one that claims two places to be the same that are not
  GraphStory story = two_rounds({});
  PoseGraph graph({});
  std::uint64_t wrong = 0;
  for (const KeyFrame& frame : story.key_frames) {
    graph.add(frame);
    const auto i = static_cast<int>(frame.id);
    if (i >= kRound && i % 4 == 0) graph.add(story.loop(i - kRound, i));
    if (i >= kRound && i % 12 == 0) {
      LoopMeasurement alias = story.loop(i - kRound, i);
      alias.T_from_to.p += Eigen::Vector3d(2.5, 0.5 * story.normal(1), 0);  // one house too far
      graph.add(alias);
      ++wrong;
    }
    graph.update();
  }
  graph.finish();
  EXPECT_EQ(graph.loop_counts().proposed - graph.loop_counts().accepted, wrong);
  GraphStory clean = two_rounds({});
  PoseGraph without({});
  play(clean, without, true);
  without.finish();
  EXPECT_LT(test::aligned_error_m(story.truth, graph), 1.5 * test::aligned_error_m(clean.truth, without));
}

TEST(PoseGraph, ALoopThatNobodySecondsWaits) {
  GraphStory story = two_rounds({});
  PoseGraph graph({});
  play(story, graph, false);
  graph.add(story.loop(10, kRound + 10));
  graph.update();
  EXPECT_FALSE(graph.constrained());
  EXPECT_EQ(graph.loop_counts().waiting, 1u);
  graph.add(story.loop(14, kRound + 14));
  graph.update();
  EXPECT_TRUE(graph.constrained());
  EXPECT_EQ(graph.loop_counts().accepted, 2u);
}

TEST(PoseGraph, LoopsThatMakeNoSenseAreCountedByCause) {
  GraphStory story = two_rounds({});
  PoseGraph graph({});
  play(story, graph, false);
  LoopMeasurement nan = story.loop(10, kRound + 10), stranger = nan, far = nan;
  nan.T_from_to.p.x() = std::nan("");
  stranger.to = 100'000;
  far.T_from_to.p.x() += 200;
  for (const LoopMeasurement& loop : {nan, stranger, far}) graph.add(loop);
  EXPECT_EQ(graph.loop_counts().not_finite, 1u);
  EXPECT_EQ(graph.loop_counts().unknown_key_frame, 1u);
  EXPECT_EQ(graph.loop_counts().against_drift, 1u);
  EXPECT_FALSE(graph.constrained());
}

TEST(PoseGraph, ALoopMayBeGivenFromEitherEnd) {
  GraphStory story = two_rounds({});
  PoseGraph forward({}), backward({});
  play(story, forward, false);
  play(story, backward, false);
  for (int i = 10; i < 40; i += 10) {
    const LoopMeasurement loop = story.loop(i, kRound + i);
    const RelativeMotion turned = inverse_of({loop.T_from_to, loop.covariance});
    forward.add(loop);
    backward.add(LoopMeasurement{loop.to, loop.from, turned.T, turned.covariance});
  }
  forward.finish();
  backward.finish();
  for (int i = 0; i < forward.size(); ++i) ASSERT_LT((forward.T_map_body(i).p - backward.T_map_body(i).p).norm(), 1e-4);
}

TEST(PoseGraph, SubMeshesMoveWithTheirKeyFrames) {
  GraphStory story = two_rounds({});
  PoseGraph graph({});
  play(story, graph, true);
  graph.finish();
  for (int i = 0; i < graph.size(); i += 25) {
    const KeyFrame& frame = graph.key_frame(i);
    const auto correction = graph.sub_mesh_correction(frame.sub_mesh);
    ASSERT_TRUE(correction);
    EXPECT_LT(((*correction * frame.T_world_body).p - graph.T_map_body(i).p).norm(), 0.1);
  }
  EXPECT_FALSE(graph.sub_mesh_correction(10'000));
}

TEST(PoseGraph, WhatWasSolvedOnTheWayIsAsGoodAsABatch) {
  GraphStory story = two_rounds({});
  GraphConfig frugal;
  frugal.work_per_key_frame = 10;  // sub-meshes alone have to do most of the time
  PoseGraph graph(frugal), batch(frugal);
  play(story, graph, true);
  const double on_the_way = graph.cost();
  graph.finish();
  GraphStory again = two_rounds({});
  for (const KeyFrame& frame : again.key_frames) batch.add(frame);
  for (int i = kRound; i < 2 * kRound; ++i)
    if (i % 4 == 0) batch.add(again.loop(i - kRound, i));
  batch.finish();
  EXPECT_GT(graph.work().sub_meshes, 0u);
  EXPECT_LT(on_the_way, 1.5 * batch.cost());
  EXPECT_NEAR(graph.cost(), batch.cost(), 0.01 * batch.cost());
}

}  // namespace
}  // namespace lxd::backend_pose_graph_test
