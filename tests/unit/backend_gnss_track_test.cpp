// SPDX-License-Identifier: Apache-2.0
// Fixes in the graph: they find where the map lies, hold the path, and are refused when they are wrong.
#include <gtest/gtest.h>

#include "tests/support/graph_story.hpp"

namespace lxd::backend_gnss_track_test {
namespace {

using test::GraphStory;

// A kilometre and a half of wide bends at 10 m/s, a fix a key frame.
GraphStory drive() {
  GraphStory story;
  story.drive(test::wide_bends(), {});
  return story;
}

using Error = std::function<Eigen::Vector3d(int key_frame)>;

struct Played {
  std::unique_ptr<PoseGraph> graph = std::make_unique<PoseGraph>(GraphConfig{});
  std::vector<Eigen::Vector3d> live_m;  // each key frame's position when it was new
};

// Nothing of the error: no fix.
Played play(GraphStory& story, double sigma_m, const std::function<std::optional<Eigen::Vector3d>(int)>& error) {
  Played played;
  for (const KeyFrame& frame : story.key_frames) {
    const auto i = static_cast<int>(frame.id);
    played.graph->add(frame);
    if (const auto e = error(i)) played.graph->add(story.fix(i, sigma_m, *e));
    played.graph->update();
    played.live_m.push_back(played.graph->T_map_body(i).p);
  }
  played.graph->finish();
  return played;
}

double odometry_error_m(GraphStory& story) {
  PoseGraph graph({});
  for (const KeyFrame& frame : story.key_frames) graph.add(frame);
  return test::aligned_error_m(story.truth, graph);
}

TEST(GnssTrack, RtkHoldsThePathAndFindsYawOffsetAndDelay) {
  GraphStory story = drive();
  const Played played = play(story, 0.02, [&](int) { return std::optional(story.normals(0.015)); });
  ASSERT_TRUE(played.graph->gnss().aligned());
  const EarthAlignment& found = played.graph->gnss().alignment();
  EXPECT_NEAR(found.yaw_rad, story.earth.yaw_rad, 1e-3);
  EXPECT_LT((found.offset_m - story.earth.offset_m).norm(), 0.1);
  EXPECT_NEAR(found.delay_s, story.earth.delay_s, 0.01);
  EXPECT_GT(odometry_error_m(story), 0.15);
  EXPECT_LT(test::aligned_error_m(story.truth, *played.graph), 0.05);
  EXPECT_GT(played.graph->gnss_counts().used, 490u);
}

TEST(GnssTrack, ADelayThatNobodyExpectedIsFound) {
  GraphStory story = drive();
  story.earth.delay_s = 0.14;
  // a constant delay along a straight way is an offset: speed must change
  for (std::size_t i = 0; i < story.key_frames.size(); ++i)
    story.key_frames[i].stamp =
        RigTime::from_seconds(static_cast<double>(i) * 0.2 + 5 * std::sin(0.01 * static_cast<double>(i)));
  const Played played = play(story, 0.02, [&](int) { return std::optional(story.normals(0.01)); });
  EXPECT_NEAR(played.graph->gnss().alignment().delay_s, 0.14, 0.02);
}

// Given centimetres of RTK, stamps that are off by 10 ms now and then, and 10 m/s, so that fixes lie a decimetre off
// along the way, then the map finds its place all the same, and the path is better than the stamps.
TEST(GnssTrack, StampsThatJitterDoNotKeepTheMapOffTheEarth) {
  GraphStory story = drive();
  constexpr double kJitter_s = 0.01;
  const Played played = play(story, 0.014, [&](int i) -> std::optional<Eigen::Vector3d> {
    const auto at = static_cast<std::size_t>(i);
    const Eigen::Vector3d late_m = story.normal(kJitter_s) * 10 * story.truth[at].R.col(0);
    return story.normals(0.014) + Exp(Eigen::Vector3d(0, 0, story.earth.yaw_rad)) * late_m;
  });
  ASSERT_TRUE(played.graph->gnss().aligned());
  EXPECT_GT(played.graph->gnss_counts().used, 400u);
  EXPECT_LT(test::aligned_error_m(story.truth, *played.graph), 10 * kJitter_s);
}

TEST(GnssTrack, SingleFixesWithAnOutageBoundTheDrift) {
  GraphStory story = drive();
  // errors that last: Gauss-Markov of 20 s at five fixes a second
  Eigen::Vector3d slow = story.normals(1.5);
  const double keep = std::exp(-0.2 / 20);
  const Played played = play(story, 1.5, [&](int i) -> std::optional<Eigen::Vector3d> {
    slow = keep * slow + story.normals(1.5 * std::sqrt(1 - keep * keep));
    if (i > 200 && i < 400) return std::nullopt;
    return slow;
  });
  EXPECT_LT(test::aligned_error_m(story.truth, *played.graph), 1.5);
  EXPECT_GT(played.graph->gnss_counts().used, 0.9 * static_cast<double>(played.graph->gnss_counts().taken));
}

// Given fixes that show no drift, and a world that began askew, then the whole path turns as one and lies on the earth.
TEST(GnssTrack, FixesThatShowNoDriftTurnThePathAndLeaveItsShape) {
  GraphStory story;
  story.drive(test::wide_bends(), {}, 10, 0);
  const Pose T_world_map{Exp(Eigen::Vector3d(0.03, -0.02, 0)), Eigen::Vector3d::Zero()};
  for (KeyFrame& frame : story.key_frames) frame.T_world_body = T_world_map * frame.T_world_body;
  const Played played = play(story, 0.02, [&](int) { return std::optional(story.normals(0.015)); });
  const PoseGraph& graph = *played.graph;
  ASSERT_TRUE(graph.gnss().aligned());
  EXPECT_NEAR(graph.gnss().alignment().yaw_rad, story.earth.yaw_rad, 1e-3);
  EXPECT_LT((graph.T_map_world().R * T_world_map.R - Eigen::Matrix3d::Identity()).norm(), 2e-3);
  EXPECT_LT(test::aligned_error_m(story.truth, graph), 1e-6);
}

// Given loops that take out a drift, and fixes of metres that cannot show it, then the loops' path stays as it is.
TEST(GnssTrack, FixesOfMetresDoNotBendAPathThatLoopsHaveMended) {
  const auto error_m = [](bool with_fixes) {
    GraphStory story;
    story.drive(test::ring(600, 2, 4), {});
    constexpr int kRound = 150;  // key frames
    PoseGraph graph({});
    std::vector<LoopMeasurement> loops;
    for (int i = kRound; i < 2 * kRound; i += 4) loops.push_back(story.loop(i - kRound, i));
    auto loop = loops.begin();
    for (const KeyFrame& frame : story.key_frames) {
      graph.add(frame);
      for (; loop != loops.end() && loop->to == frame.id; ++loop) graph.add(*loop);
      if (with_fixes) graph.add(story.fix(static_cast<int>(frame.id), 1.5, story.normals(1)));
      graph.update();
    }
    graph.finish();
    EXPECT_EQ(graph.gnss().aligned(), with_fixes);
    return test::aligned_error_m(story.truth, graph);
  };
  EXPECT_LT(error_m(true), 1.1 * error_m(false));
}

// Also soon after the map has found its place, when little of the way has shown the yaw.
TEST(GnssTrack, AJumpOfTwentyMetresIsRefusedAndMovesNothing) {
  for (const auto& [begin, sigma_m] : {std::pair(125, 0.02), {250, 0.02}, {400, 0.02}, {400, 1.5}}) {
    GraphStory story = drive(), same = drive();
    const auto noise = [sigma = sigma_m / 5](GraphStory& s) { return s.normals(sigma); };
    const auto is_off = [first = begin](int i) { return i >= first && i < first + 25; };  // five seconds
    const auto jumping = [&](int i) {
      return std::optional<Eigen::Vector3d>(noise(story) + (is_off(i) ? 20.0 : 0.0) * Eigen::Vector3d::UnitX());
    };
    // the witness has no fix while the other is off
    const auto quiet = [&](int i) {
      const Eigen::Vector3d e = noise(same);
      return is_off(i) ? std::nullopt : std::optional(e);
    };
    const Played jumped = play(story, sigma_m, jumping), witness = play(same, sigma_m, quiet);
    EXPECT_EQ(jumped.graph->gnss_counts().jumped, 25u) << begin << " " << sigma_m;
    for (int i = begin; i < begin + 10; ++i)  // two seconds
      EXPECT_LT((jumped.live_m[static_cast<std::size_t>(i)] - witness.live_m[static_cast<std::size_t>(i)]).norm(), 0.01)
          << begin << " " << sigma_m;
    EXPECT_LT(test::aligned_error_m(story.truth, *jumped.graph), odometry_error_m(story));
  }
}

// Where a round closes, first and last fix lie together; the yaw is known from the way between.
TEST(GnssTrack, AJumpWhereARoundClosesIsRefused) {
  GraphStory story;
  story.drive(test::ring(1200, 1.5, 2), {});
  constexpr int kRound = 600;  // key frames
  const Played played = play(story, 1.5, [&](int i) {
    const bool off = i >= kRound - 10 && i < kRound + 10;
    return std::optional<Eigen::Vector3d>(story.normals(0.3) + (off ? 20.0 : 0.0) * Eigen::Vector3d::UnitX());
  });
  EXPECT_EQ(played.graph->gnss_counts().jumped, 20u);
}

TEST(GnssTrack, AReceiverThatRepeatsOnePlaceIsNotBelieved) {
  GraphStory story = drive();
  PoseGraph graph({});
  for (const KeyFrame& frame : story.key_frames) {
    graph.add(frame);
    GnssMeasurement fix = story.fix(static_cast<int>(frame.id), 1.5, Eigen::Vector3d::Zero());
    fix.enu_m.setZero();
    graph.add(fix);
    graph.update();
  }
  graph.finish();
  EXPECT_FALSE(graph.constrained());
  EXPECT_EQ(graph.gnss_counts().used, 0u);
  EXPECT_EQ(graph.gnss_counts().unaligned, graph.gnss_counts().taken);
  EXPECT_EQ(graph.T_map_body(450).p, story.key_frames[450].T_world_body.p);
}

TEST(GnssTrack, AReceiverThatFreezesOnTheWayIsRefused) {
  GraphStory story = drive();
  const Eigen::Vector3d frozen_at = story.earth.to_enu(story.truth[300].p);
  const Played played = play(story, 1.5, [&](int i) {
    const Eigen::Vector3d truth = story.earth.to_enu(story.truth[static_cast<std::size_t>(i)].p);
    return std::optional<Eigen::Vector3d>(i < 300 ? story.normals(0.5) : Eigen::Vector3d(frozen_at - truth));
  });
  EXPECT_GT(played.graph->gnss_counts().jumped, 150u);
}

TEST(GnssTrack, AnotherDatumFromTheBeginningIsOnlyAnotherOffset) {
  GraphStory story = drive();
  const Eigen::Vector3d datum(-85, 120, 45);
  const Played played =
      play(story, 0.05, [&](int) { return std::optional<Eigen::Vector3d>(datum + story.normals(0.05)); });
  EXPECT_LT(test::aligned_error_m(story.truth, *played.graph), 0.15);
  EXPECT_LT((played.graph->gnss().alignment().offset_m - story.earth.offset_m - datum).norm(), 0.3);
}

TEST(GnssTrack, AnotherDatumOnTheWayIsRefused) {
  GraphStory story = drive();
  const Played played = play(story, 0.5, [&](int i) {
    return std::optional<Eigen::Vector3d>(story.normals(0.3) +
                                          (i < 400 ? Eigen::Vector3d::Zero() : Eigen::Vector3d(-85, 120, 45)));
  });
  EXPECT_EQ(played.graph->gnss_counts().jumped, 100u);
}

TEST(GnssTrack, LeapsAtTheBeginningDoNotSpoilTheAlignment) {
  GraphStory story = drive();
  const Played played = play(story, 1.0, [&](int i) {
    return std::optional<Eigen::Vector3d>(
        story.normals(0.7) + (i % 5 == 2 && i < 60 ? Eigen::Vector3d(30, -20, 0) : Eigen::Vector3d::Zero()));
  });
  ASSERT_TRUE(played.graph->gnss().aligned());
  EXPECT_NEAR(played.graph->gnss().alignment().yaw_rad, story.earth.yaw_rad, 0.01);
  EXPECT_EQ(
      played.graph->gnss_counts().unaligned + played.graph->gnss_counts().jumped + played.graph->gnss_counts().outlying,
      12u);
}

TEST(GnssTrack, FixesThatAreNoNumbersAreCounted) {
  GraphStory story = drive();
  PoseGraph graph({});
  graph.add(story.key_frames[0]);
  GnssMeasurement nan = story.fix(0, 1, {std::nan(""), 0, 0}), unknown = story.fix(0, 1, {0, 0, 0}), flat = unknown;
  unknown.key_frame = 9;
  flat.covariance_m2 = -Eigen::Matrix3d::Identity();
  for (const GnssMeasurement& m : {nan, unknown, flat}) graph.add(m);
  EXPECT_EQ(graph.gnss_counts().not_finite, 3u);
}

}  // namespace
}  // namespace lxd::backend_gnss_track_test
