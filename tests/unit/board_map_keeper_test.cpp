// SPDX-License-Identifier: Apache-2.0
// From sweeps and fixes to the graph: which poses become key frames, what a fix is worth, and that a thread of its own
// changes nothing.
#include <gtest/gtest.h>

#include "board/gnss_intake.hpp"
#include "board/graph_worker.hpp"
#include "board/key_frame_cutter.hpp"
#include "tests/support/graph_story.hpp"
#include "tests/support/town_journey.hpp"

namespace lxd::board_map_keeper_test {
namespace {

RigTime at(double s) { return RigTime::from_seconds(100 + s); }

SweepOutcome sweep(double t_s, double x_m, double yaw_rad = 0) {
  SweepOutcome outcome;
  outcome.stamp = at(t_s);
  outcome.T_world_body = {Exp(Eigen::Vector3d(0, 0, yaw_rad)), {x_m, 0, 0}};
  outcome.covariance = 1e-6 * (1 + t_s) * Matrix6d::Identity();
  return outcome;
}

TEST(KeyFrameCutter, CutsByWayTurnTimeAndSubMesh) {
  KeyFrameCutter cutter({});
  EXPECT_TRUE(cutter.take(sweep(0, 0), at(0), {}));  // the first always
  EXPECT_FALSE(cutter.take(sweep(0.1, 1.5), at(0), {}));
  const auto by_way = cutter.take(sweep(0.2, 2.1), at(0), {});
  ASSERT_TRUE(by_way);
  EXPECT_EQ(by_way->id, 1);
  EXPECT_NEAR(by_way->travelled_m, 2.1, 1e-12);
  EXPECT_TRUE(cutter.take(sweep(0.3, 2.1, 0.4), at(0), {}));
  EXPECT_FALSE(cutter.take(sweep(1, 2.1, 0.4), at(0), {}));
  EXPECT_TRUE(cutter.take(sweep(5.4, 2.1, 0.4), at(0), {}));
  const auto by_sub_mesh = cutter.take(sweep(5.5, 2.2, 0.4), at(5.5), {});
  ASSERT_TRUE(by_sub_mesh);
  EXPECT_EQ(by_sub_mesh->id, 4);
  EXPECT_EQ(by_sub_mesh->sub_mesh, 1);
}

TEST(KeyFrameCutter, TheMotionsDoubtIsByHowMuchThePosesHasGrown) {
  KeyFrameCutter cutter({});
  cutter.take(sweep(0, 0), at(0), {});
  const auto grown = cutter.take(sweep(1, 3), at(0), {});
  EXPECT_NEAR(grown->motion_covariance(3, 3), 1e-6, 1e-12);
  SweepOutcome sure = sweep(2, 6);
  sure.covariance *= 0.01;  // the filter has learned: the motion between is not negative
  const auto shrunk = cutter.take(sure, at(0), {});
  EXPECT_GE(shrunk->motion_covariance.diagonal().minCoeff(), 0);
}

TEST(KeyFrameCutter, UpIsToldInTheBody) {
  KeyFrameCutter cutter({});
  SweepOutcome outcome = sweep(0, 0);
  outcome.T_world_body.R = Exp(Eigen::Vector3d(0.5, 0, 0));
  const auto frame = cutter.take(outcome, at(0), Eigen::Vector3d(0, 0, 9.8));
  ASSERT_TRUE(frame->up_body);
  EXPECT_LT((outcome.T_world_body.R * *frame->up_body - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
}

GnssFix fix_at(double t_s, double latitude_deg, GnssQuality quality = GnssQuality::rtk_fixed) {
  GnssFix fix;
  fix.received = at(t_s);
  fix.quality = quality;
  fix.latitude_deg = latitude_deg;
  fix.longitude_deg = 8;
  fix.altitude_msl_m = 400;
  fix.geoid_m = 47;
  return fix;
}

TEST(GnssIntake, AFixIsCarriedByThePathToTheKeyFrameBefore) {
  // given a body that turned left and drives along the world's y at 10 m/s, its antenna a metre ahead
  GnssIntake intake({1, 0, 0});
  const Eigen::Matrix3d left = Exp(Eigen::Vector3d(0, 0, M_PI / 2));
  KeyFrame key_frame;
  key_frame.id = 3;
  key_frame.T_world_body = {left, {0, 0, 0}};
  intake.take(fix_at(0.15, 47), {});
  // when the sweeps at 0.1 s and 0.2 s enclose a fix
  const auto none = intake.advance(at(0), {left, {0, 0, 0}}, at(0.1), {left, {0, 1, 0}}, key_frame);
  const auto some = intake.advance(at(0.1), {left, {0, 1, 0}}, at(0.2), {left, {0, 2, 0}}, key_frame);
  // then the antenna was 2.5 m ahead of the key frame
  EXPECT_FALSE(none);
  ASSERT_TRUE(some);
  EXPECT_EQ(some->key_frame, 3);
  EXPECT_LT((some->antenna_body_m - Eigen::Vector3d(2.5, 0, 0)).norm(), 1e-9);
  EXPECT_LT((some->antenna_velocity_mps - Eigen::Vector3d(10, 0, 0)).norm(), 1e-9);
  EXPECT_LT(some->enu_m.norm(), 1e-6);
}

TEST(GnssIntake, OneFixAKeyFrameAndMetresFromTheFirst) {
  GnssIntake intake(Eigen::Vector3d::Zero());
  KeyFrame key_frame;
  for (double t_s : {0.02, 0.04, 0.06}) intake.take(fix_at(t_s, 47 + t_s * 1e-3), {});
  const auto first = intake.advance(at(0), {}, at(0.1), {}, key_frame);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->stamp, at(0.02));
  intake.take(fix_at(0.12, 47.001), {});
  EXPECT_FALSE(intake.advance(at(0.1), {}, at(0.2), {}, key_frame));
  key_frame.id = 1;
  intake.take(fix_at(0.22, 47.001), {});
  const auto second = intake.advance(at(0.2), {}, at(0.3), {}, key_frame);
  ASSERT_TRUE(second);
  EXPECT_NEAR(second->enu_m.y(), 111'170 * (0.001 - 0.02e-3), 5);  // a degree of latitude
}

TEST(GnssIntake, WhatIsNoPlaceIsCountedByCause) {
  GnssIntake intake(Eigen::Vector3d::Zero());
  GnssFix none = fix_at(0, 47), zero = none, low = none, manual = none;
  none.quality = GnssQuality::none;
  zero.latitude_deg = zero.longitude_deg = 0;
  low.altitude_msl_m.reset();
  manual.quality = GnssQuality::manual;
  for (const GnssFix& fix : {none, zero, zero, low, manual}) intake.take(fix, {});
  const std::map<std::string, std::uint64_t> wanted{
      {"no_position", 1}, {"zero", 2}, {"no_height", 1}, {"unknown_quality", 1}};
  EXPECT_EQ(intake.rejected(), wanted);
}

TEST(GraphWorkerThread, AThreadOfItsOwnGivesTheSameBits) {
  test::GraphStory story;
  story.drive(test::ring(300, 2, 4), {});
  GraphWorker beside({}, true), within({}, false);
  for (GraphWorker* worker : {&beside, &within}) {
    test::GraphStory told = story;
    for (const KeyFrame& frame : told.key_frames) {
      worker->post(frame);
      const auto i = static_cast<int>(frame.id);
      worker->post(told.fix(i, 0.02, told.normals(0.01)));
      if (i > 80 && i % 5 == 0) worker->post(told.loop(i - 75, i));
    }
  }
  const PoseGraph &a = beside.finish(), &b = within.finish();
  ASSERT_EQ(a.size(), b.size());
  ASSERT_TRUE(a.constrained());
  for (int i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a.T_map_body(i).p, b.T_map_body(i).p);
    ASSERT_EQ(a.T_map_body(i).R, b.T_map_body(i).R);
  }
  EXPECT_EQ(beside.latency().count(), within.latency().count());
}

TEST(GraphWorkerThread, ARunThatIsGivenUpEndsItsThread) {
  test::GraphStory story;
  story.drive(test::ring(300, 2, 4), {});
  GraphWorker worker({}, true);
  for (const KeyFrame& frame : story.key_frames) worker.post(frame);
}

// A round over three towns, and over them again, as another back-end takes it.
std::vector<Pose> rounds_by(BackEndPace pace) {
  MapKeeper keeper(Configuration{}, Star{}, pace);
  test::TownJourney journey(keeper);
  std::vector<RigTime> stamps;
  for (const double drift_m : {0.0, 0.3}) {
    for (int town = 0; town < 6; ++town) {
      const auto seen = journey.drive(static_cast<std::uint32_t>(town), test::level_pose(0, 60 * town + drift_m, 0));
      for (const auto& at : seen) stamps.push_back(at.stamp);
    }
  }
  keeper.finish();
  std::vector<Pose> corrected;
  for (const RigTime stamp : stamps) corrected.push_back(keeper.corrections().correct(stamp, Pose()));
  return corrected;
}

// Given a back-end that searches beside the sweeps, then every pose is that of one which searches within them.
TEST(MapKeeperThread, SearchesBesideTheSweepsGiveTheSameMap) {
  const auto within = rounds_by(BackEndPace::within), beside = rounds_by(BackEndPace::beside);
  ASSERT_EQ(within.size(), beside.size());
  double moved_m = 0;
  for (std::size_t i = 0; i < within.size(); ++i) {
    EXPECT_EQ(within[i].p, beside[i].p) << i;
    moved_m = std::max(moved_m, within[i].p.norm());
  }
  EXPECT_GT(moved_m, 0.05) << "nothing was closed";
}

// Given sub-meshes that may come faster than they can be searched, then a live rig has every key frame all the same,
// and no more searches are left out than had no room.
TEST(MapKeeperThread, ALiveRigLeavesOutOnlySearchesThatHaveNoRoom) {
  MapKeeper keeper(Configuration{}, Star{}, BackEndPace::live);
  test::TownJourney journey(keeper);
  constexpr int kTowns = 24;
  for (int town = 0; town < kTowns; ++town)
    journey.drive(static_cast<std::uint32_t>(town), test::level_pose(0, 60 * town, 0));
  keeper.finish();
  Report report;
  keeper.write(report);
  EXPECT_EQ(report.back_end.key_frames, static_cast<std::uint64_t>(kTowns * test::kTownFrames));
  EXPECT_LE(report.rejected["loops"]["unsought_sub_mesh"], kTowns - 8U) << "for eight there is always room";
}

}  // namespace
}  // namespace lxd::board_map_keeper_test
