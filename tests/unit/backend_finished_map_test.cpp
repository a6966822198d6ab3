// SPDX-License-Identifier: Apache-2.0
// A path that is found in a finished map is in that map's frame, and bends to it.
#include <gtest/gtest.h>

#include "tests/support/graph_story.hpp"

namespace lxd::backend_finished_map_test {
namespace {

using test::GraphStory;

const Pose kT_map_truth{Exp(Eigen::Vector3d(0, 0, 2.0)), {300, -40, 5}};

// A path of which the filter knows nothing but where it began, and what is found of it in a finished map.
// Its odometry drifts `times` as much as usual, and the graph knows.
struct Found {
  GraphStory story;
  PoseGraph graph;

  explicit Found(double times = 1) : graph(drifting(times)) {
    story.drive(test::ring(400, 1, 4), drifting(times));
    for (const KeyFrame& frame : story.key_frames) graph.add(frame);
  }
  static GraphConfig drifting(double times) {
    GraphConfig config;
    for (double* drift : {&config.drift_m_per_sqrt_m, &config.drift_rad_per_sqrt_m, &config.drift_rad_per_sqrt_rad})
      *drift *= times;
    return config;
  }
  [[nodiscard]] Pose truth_in_map(int i) const { return kT_map_truth * story.truth[static_cast<std::size_t>(i)]; }
  PlaceMeasurement place(int i, const Pose& wrong = {}, int map = 0) {
    Vector6d sigmas, error;
    sigmas << Eigen::Vector3d::Constant(2e-3), Eigen::Vector3d::Constant(0.03);
    error.head<3>() = story.normals(2e-3);
    error.tail<3>() = story.normals(0.03);
    return {i, map, box_plus(wrong * truth_in_map(i), error), sigmas.cwiseAbs2().asDiagonal()};
  }
  [[nodiscard]] double worst_m() const {
    double worst = 0;
    for (int i = 0; i < graph.size(); ++i) worst = std::max(worst, (graph.T_map_body(i).p - truth_in_map(i).p).norm());
    return worst;
  }
};

TEST(FinishedMap, OneSightAloneIsNotBelieved) {
  Found path;
  path.graph.add(path.place(10));
  path.graph.finish();
  EXPECT_FALSE(path.graph.constrained());
  EXPECT_TRUE(path.graph.places().empty());
  EXPECT_EQ(path.graph.T_map_body(50).p, path.story.key_frames[50].T_world_body.p);
  EXPECT_EQ(path.graph.place_counts().waiting, 1U);
}

TEST(FinishedMap, TwoThatAgreeTakeThePathIntoItsFrame) {
  Found path;
  for (int i : {10, 60, 95}) path.graph.add(path.place(i));
  path.graph.finish();
  ASSERT_EQ(path.graph.places().size(), 3U);
  EXPECT_LT(path.worst_m(), 0.3);
}

TEST(FinishedMap, WhatComesAfterwardsIsThereAtOnce) {
  GraphStory story;
  story.drive(test::ring(400, 1, 4), {});
  PoseGraph graph{GraphConfig{}};
  for (const KeyFrame& frame : story.key_frames) {
    graph.add(frame);
    const auto i = static_cast<int>(frame.id);
    if (i == 20 || i == 30)
      graph.add(
          PlaceMeasurement{i, 0, kT_map_truth * story.truth[static_cast<std::size_t>(i)], 1e-4 * Matrix6d::Identity()});
    graph.update();
    const Pose wanted = (i < 30 ? Pose() : kT_map_truth) * story.truth[static_cast<std::size_t>(i)];
    ASSERT_LT((graph.T_map_body(i).p - wanted.p).norm(), 1.0) << i;
  }
}

TEST(FinishedMap, DriftIsTakenOutAllAlongTheWay) {
  Found path(10);
  for (int i = 5; i < 100; i += 3) path.graph.add(path.place(i));
  path.graph.finish();
  EXPECT_LT(path.worst_m(), 1.2);
  // given that odometry by itself, put where the first sight has it, is metres off
  const Pose T = path.truth_in_map(5) * path.story.key_frames[5].T_world_body.inverse();
  const double odometry_m = ((T * path.story.key_frames[99].T_world_body).p - path.truth_in_map(99).p).norm();
  EXPECT_GT(odometry_m, 1.5 * path.worst_m());
}

TEST(FinishedMap, LookAlikesAreOutvoted) {
  Found path;
  const Pose elsewhere{Exp(Eigen::Vector3d(0, 0, 1)), {20, 10, 0}};
  path.graph.add(path.place(10, elsewhere));
  path.graph.add(path.place(12, elsewhere));  // two that agree: believed for now
  path.graph.update();
  EXPECT_EQ(path.graph.places().size(), 2U);
  for (int i : {30, 50, 70}) path.graph.add(path.place(i));
  path.graph.finish();
  EXPECT_EQ(path.graph.places().size(), 3U);
  EXPECT_LT(path.worst_m(), 0.3);
}

TEST(FinishedMap, SightsInDifferentMapsDoNotAgree) {
  Found path;
  path.graph.add(path.place(10, {}, 0));
  path.graph.add(path.place(40, {}, 1));
  EXPECT_FALSE(path.graph.constrained());
  path.graph.add(path.place(60, {}, 1));
  path.graph.finish();
  ASSERT_EQ(path.graph.places().size(), 2U);
  EXPECT_EQ(path.graph.places().front().map, 1);
}

TEST(FinishedMap, OwnLoopsAndTheMapGoTogether) {
  Found path(5);
  for (int i : {60, 75, 90}) path.graph.add(path.place(i));
  for (int i = 0; i < 4; ++i) path.graph.add(path.story.loop(i, 99 - i));
  path.graph.finish();
  EXPECT_GT(path.graph.loop_counts().accepted, 1U);
  EXPECT_LT(path.worst_m(), 1.2);
}

TEST(FinishedMap, FixesOfGnssStayWithTheEarth) {
  // given a map that fixes have shown the place of, when it turns out to lie in another one
  Found path;
  for (int i = 0; i < 100; ++i) path.graph.add(path.story.fix(i, 0.02, path.story.normals(0.01)));
  ASSERT_TRUE(path.graph.gnss().aligned());
  for (int i : {20, 60, 95}) path.graph.add(path.place(i));
  path.graph.finish();
  // then both hold
  EXPECT_LT(path.worst_m(), 0.3);
  EXPECT_GT(path.graph.gnss_counts().used, 80U);
}

TEST(FinishedMap, WhatIsNoPlaceIsRefused) {
  Found path;
  PlaceMeasurement bad = path.place(10);
  bad.T_map_body.p.x() = NAN;
  path.graph.add(bad);
  path.graph.add(path.place(99));
  PlaceMeasurement beyond = path.place(10);
  beyond.key_frame = 5000;
  path.graph.add(beyond);
  EXPECT_EQ(path.graph.place_counts().not_sound, 2U);
  EXPECT_FALSE(path.graph.constrained());
}

}  // namespace
}  // namespace lxd::backend_finished_map_test
