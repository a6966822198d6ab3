// SPDX-License-Identifier: Apache-2.0
// Where a run is in what is finished: an earlier session's map, or what came before the filter began again.
#include <gtest/gtest.h>

#include "board/earlier_map.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/town_journey.hpp"

namespace lxd::board_earlier_map_test {
namespace {

using test::level_pose;
using test::TownJourney;

class EarlierMapStory : public ::testing::Test {
 protected:
  // Worst distance from where the map has the town.
  static double off_m(const MapKeeper& keeper, const std::vector<TownJourney::Seen>& seen, const Pose& T_map_town) {
    double worst = 0;
    for (const auto& at : seen) {
      const Pose T = keeper.corrections().correct(at.stamp, at.T_world_body);
      worst = std::max(worst, (T.p - (T_map_town * at.T_town_body).p).norm());
    }
    return worst;
  }
  Report reported() {
    keeper_.finish();
    Report report;
    keeper_.write(report);
    return report;
  }
  void remember(bool localise = false) {
    auto earlier = open_earlier_map({file_, localise}, folder_ / "run");
    ASSERT_TRUE(earlier.ok()) << earlier.error().message;
    ASSERT_TRUE(keeper_.remember(**earlier).ok());
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "old/map.db";
  MapKeeper keeper_{Configuration{}, Star{}, BackEndPace::within};
};

// Given a map of three towns, when a journey that began elsewhere comes through two of them, then it is in that map.
TEST_F(EarlierMapStory, APathThatIsFoundIsInItsFrame) {
  std::filesystem::create_directories(folder_ / "old");
  const Pose first = level_pose(0.3, 500, 20), second = level_pose(0.1, 560, 40);
  test::write_town_map(file_, {{1, first}, {2, second}, {3, level_pose(0, 640, 0)}});
  remember();
  TownJourney journey(keeper_);
  const Pose T_world_map = level_pose(1.7, -30, 8, 0.5);
  const auto nowhere = journey.drive(9, T_world_map * level_pose(0, 440, 0));
  const auto in_first = journey.drive(1, T_world_map * first);
  const auto in_second = journey.drive(2, T_world_map * second);
  const Report report = reported();
  EXPECT_LT(off_m(keeper_, in_first, first), 0.1);
  EXPECT_LT(off_m(keeper_, in_second, second), 0.1);
  EXPECT_LT(off_m(keeper_, nowhere, level_pose(0, 440, 0)), 0.5);
  EXPECT_EQ(keeper_.corrections().main(), kEarlierMap);
  ASSERT_TRUE(report.map.relocalised_t_s);
  EXPECT_GE(*report.map.relocalised_t_s, in_first.front().stamp.seconds());
  EXPECT_LE(*report.map.relocalised_t_s, in_first.back().stamp.seconds());
  EXPECT_GE(report.map.places, 2U);
  EXPECT_TRUE(report.hints.empty());
}

TEST_F(EarlierMapStory, APathThatIsNeverFoundKeepsItsFrameAndSaysSo) {
  std::filesystem::create_directories(folder_ / "old");
  test::write_town_map(file_, {{1, {}}, {2, level_pose(0, 60, 0)}});
  remember();
  TownJourney journey(keeper_);
  const auto seen = journey.drive(5, level_pose(0, 0, 0));
  journey.drive(6, level_pose(0, 60, 0));
  const Report report = reported();
  EXPECT_FALSE(keeper_.corrections().moved());
  EXPECT_EQ(keeper_.corrections().piece(seen.front().stamp), 0);
  EXPECT_FALSE(report.map.relocalised_t_s);
  ASSERT_EQ(report.hints.size(), 1U);
  EXPECT_NE(report.hints[0].find("never found in " + file_.string()), std::string::npos) << report.hints[0];
}

// Given a filter that lost its way and began again at zero, when it comes to where it was before, then both are one.
TEST_F(EarlierMapStory, ANewBeginningIsFoundInItsOwnMap) {
  TownJourney journey(keeper_);
  journey.drive(1, level_pose(0, 0, 0));
  const Pose second = level_pose(0, 60, 0);
  journey.drive(2, second);
  keeper_.begin_again();
  const Pose T_new_old = level_pose(-2, 3, 4);
  const auto again = journey.drive(2, T_new_old * second);
  const auto beyond = journey.drive(7, T_new_old * level_pose(0, 60, 60));
  const Report report = reported();
  EXPECT_EQ(report.map.pieces, 2U);
  EXPECT_EQ(report.map.pieces_apart, 0U);
  EXPECT_GE(report.map.places, 2U);
  EXPECT_LT(off_m(keeper_, again, second), 0.1);
  EXPECT_LT(off_m(keeper_, beyond, level_pose(0, 60, 60)), 0.5);
  EXPECT_FALSE(keeper_.corrections().in_pieces());
}

TEST_F(EarlierMapStory, ANewBeginningThatIsNeverFoundIsAPieceApart) {
  TownJourney journey(keeper_);
  const auto first = journey.drive(1, level_pose(0, 0, 0));
  keeper_.begin_again();
  const auto longer = journey.drive(5, level_pose(0, 0, 0));
  journey.drive(6, level_pose(0, 60, 0));
  const Report report = reported();
  EXPECT_EQ(report.map.pieces_apart, 1U);
  EXPECT_NE(keeper_.corrections().piece(first.front().stamp), 0) << "the shorter one is apart";
  EXPECT_EQ(keeper_.corrections().piece(longer.front().stamp), 0);
  ASSERT_EQ(report.hints.size(), 1U);
  EXPECT_NE(report.hints[0].find("never found in the others"), std::string::npos);
}

// Given three pieces, when the third is found in the second and that in the first, then all are in the first's frame.
TEST_F(EarlierMapStory, PiecesAreJoinedOneByOne) {
  TownJourney journey(keeper_);
  journey.drive(1, level_pose(0, 0, 0));
  keeper_.begin_again();
  const Pose second = level_pose(1, 100, 0), third = level_pose(2, 0, 100);
  journey.drive(1, second);
  journey.drive(2, second * level_pose(0, 60, 0));
  keeper_.begin_again();
  const auto last = journey.drive(2, third);
  const Report report = reported();
  EXPECT_EQ(report.map.pieces_apart, 0U);
  EXPECT_LT(off_m(keeper_, last, level_pose(0, 60, 0)), 0.15);
}

TEST_F(EarlierMapStory, KeyFramesAreKeptWithTheirSubMesh) {
  TownJourney journey(keeper_);
  journey.drive(1, level_pose(0.5, 10, 0));
  journey.drive(2, level_pose(0, 60, 0));
  ASSERT_EQ(journey.key_frames().size(), 2U);
  for (const auto& frames : journey.key_frames()) {
    ASSERT_EQ(frames.size(), static_cast<std::size_t>(test::kTownFrames));
    EXPECT_LT((frames[3].T_submesh_body.p - test::body_in_town(3).p).norm(), 1e-9);
  }
  reported();
}

// What a user may mistake: each is told, and nothing is written.
TEST_F(EarlierMapStory, WhatIsNoMapToGoOnFromIsRefused) {
  std::filesystem::create_directories(folder_ / "old");
  const auto refusal = [&](const EarlierMapRequest& request, const std::filesystem::path& out) {
    const auto opened = open_earlier_map(request, out);
    return opened.ok() ? std::string("none") : opened.error().message;
  };
  EXPECT_NE(refusal({std::nullopt, true}, "run").find("found no --map"), std::string::npos);
  EXPECT_NE(refusal({file_, false}, "run").find("No such file"), std::string::npos);
  test::write_file(file_, "precious");
  EXPECT_NE(refusal({file_, false}, "run").find("not a map archive"), std::string::npos);
  ASSERT_TRUE(ArchiveWriter::create(file_)->finish().ok());
  EXPECT_NE(refusal({file_, false}, "run").find("found no sub-mesh"), std::string::npos);
  test::write_town_map(file_, {{1, {}}});
  EXPECT_NE(refusal({file_, false}, folder_ / "old").find("wanted another one for this run"), std::string::npos);
  EXPECT_EQ(refusal({file_, false}, folder_ / "run"), "none");
  EXPECT_EQ(refusal({folder_ / "old", false}, folder_ / "run"), "none") << "the run's folder will do";
  EXPECT_EQ(refusal({}, folder_ / "run"), "none");
}

}  // namespace
}  // namespace lxd::board_earlier_map_test
