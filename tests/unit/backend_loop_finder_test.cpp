// SPDX-License-Identifier: Apache-2.0
// Loops: true ones are measured, false ones are told, directions that nothing holds are left open, work is bounded.
#include <cmath>

#include <gtest/gtest.h>

#include "backend/loops/loop_finder.hpp"
#include "tests/support/loop_scene.hpp"

namespace lxd::backend_loop_finder_test {
namespace {

constexpr double kCarrier_m = 1.5;

Surroundings around(const std::vector<MeshVertex>& vertices, double x_m, double y_m) {
  const auto surfels = thin_surfels(vertices, {});
  const Eigen::Vector3d place(x_m, y_m, kCarrier_m);
  return surroundings_of(surfels, place, make_scan_context(surfels, place, {}), VerificationConfig{}.radius_m);
}

Verification verify(const Surroundings& query, const Surroundings& candidate, double yaw_rad) {
  return verify_loop(query, candidate, yaw_rad, {}, {});
}

TEST(LoopVerification, FindsWhereTheKeyFrameWas) {
  // Given a place seen again 2.3 m and 1.1 m aside, in axes turned by 40 degrees, lower by 30 cm
  const std::vector<MeshVertex> there = test::town(1).vertices;
  const double yaw_rad = 0.7;
  const Pose T_there_here = test::level_pose(yaw_rad, 2.3, -1.1, 0.3);
  const std::vector<MeshVertex> here = test::moved(there, T_there_here.inverse());
  const auto surfels = thin_surfels(here, {});
  const Eigen::Vector3d place(0, 0, kCarrier_m);
  const Surroundings query = surroundings_of(surfels, place, make_scan_context(surfels, place, {}), 45);
  // When
  const Verification found = verify(query, around(there, 0, 0), yaw_rad + 0.05);
  // Then
  ASSERT_EQ(found.verdict, LoopVerdict::accepted) << found.overlap << ' ' << found.rms_m << ' ' << found.open_sigma_m;
  EXPECT_LT((found.T_candidate_query.p - T_there_here.p).norm(), 0.02);
  EXPECT_LT(Log(found.T_candidate_query.R.transpose() * T_there_here.R).norm(), 0.003);
  EXPECT_LT(std::sqrt(found.covariance.diagonal().maxCoeff()), 0.1);
}

TEST(LoopVerification, AnotherPlaceIsNotTaken) {
  const Surroundings here = around(test::town(1).vertices, 0, 0);
  for (std::uint32_t seed = 2; seed < 6; ++seed)
    EXPECT_EQ(verify(here, around(test::town(seed).vertices, 0, 0), 0).verdict, LoopVerdict::little_overlap) << seed;
}

TEST(LoopVerification, ASmoothCorridorIsNoPlace) {
  // Given two corridors that are alike, and nothing that would tell how far along
  const std::vector<MeshVertex> corridor = test::corridor().vertices;
  const Verification found = verify(around(corridor, 3, 0), around(corridor, 0, 0), 0);
  EXPECT_NE(found.verdict, LoopVerdict::accepted);
  // Then its covariance says so along it, and not across
  EXPECT_GT(std::sqrt(found.covariance(3, 3)), 1.0);
  EXPECT_LT(std::sqrt(found.covariance(4, 4)), 0.1);
  EXPECT_LT(std::sqrt(found.covariance(5, 5)), 0.1);
}

TEST(LoopVerification, NothingToSeeIsSaid) {
  EXPECT_EQ(verify(around(test::town(1).vertices, 0, 0), around({}, 0, 0), 0).verdict, LoopVerdict::little_seen);
  EXPECT_EQ(verify(around({}, 0, 0), around({}, 0, 0), 0).verdict, LoopVerdict::little_seen);
}

// A way through towns, one a sub-mesh, 40 m each, whose last is the first again.
class Round {
 public:
  explicit Round(const LoopFinderConfig& config) : finder(config) {}

  // The town's sub-mesh with key frames 0.5 m apart about its middle, estimated to be at `at`.
  void drive(std::uint32_t seed, const Pose& T_world_town, int key_frames) {
    const std::vector<MeshVertex> vertices = test::town(seed).vertices;
    std::vector<LoopKeyFrame> frames;
    for (int i = 0; i < key_frames; ++i)
      frames.push_back({id_++, T_world_town * body(i, key_frames), path_m_ += 1.0, true});
    path_m_ += 20;
    finder.add({submesh_++, T_world_town, vertices}, frames);
  }
  // Of the i-th key frame in the town; the body leans and turns.
  static Pose body(int i, int of) {
    return {Exp(Eigen::Vector3d(0.05, -0.03, 0.4 * i)), Eigen::Vector3d(0.5 * (i - of / 2), 0.2 * i, kCarrier_m)};
  }
  std::vector<LoopMeasurement> find_all() {
    std::vector<LoopMeasurement> out;
    do {
      for (const LoopMeasurement& loop : finder.find()) out.push_back(loop);
    } while (finder.waiting() > 0);
    return out;
  }

  LoopFinder finder;

 private:
  std::int64_t id_ = 0, submesh_ = 0;
  double path_m_ = 0;
};

TEST(LoopFinder, ClosesTheRoundAndNothingElse) {
  Round round({});
  for (std::uint32_t seed = 1; seed < 5; ++seed) round.drive(seed, test::level_pose(0, 5.0 * seed, 0), 3);
  EXPECT_TRUE(round.find_all().empty());
  // When the first town comes again, where drift has put it 2 m aside and turned
  round.drive(1, test::level_pose(0.02, 7, 0), 3);
  const auto loops = round.find_all();
  // Then
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_LT(loops[0].from, 3);
  EXPECT_GE(loops[0].to, 12);
  const Pose truth =
      Round::body(static_cast<int>(loops[0].from), 3).inverse() * Round::body(static_cast<int>(loops[0].to - 12), 3);
  EXPECT_LT((loops[0].T_from_to.p - truth.p).norm(), 0.03);
  EXPECT_LT(Log(loops[0].T_from_to.R.transpose() * truth.R).norm(), 0.003);
  EXPECT_EQ(round.finder.counters().accepted(), 1U);
}

TEST(LoopFinder, LeavesAloneWhatTheFilterStillSees) {
  Round round({});
  round.drive(1, {}, 3);
  round.drive(1, {}, 3);
  round.drive(1, {}, 3);
  EXPECT_TRUE(round.find_all().empty());
  EXPECT_EQ(round.finder.counters().proposed, 0U);
}

TEST(LoopFinder, PosesRuleOutALookAlikeFarAway) {
  Round round({});
  for (std::uint32_t seed = 1; seed < 5; ++seed) round.drive(seed, test::level_pose(0, 5.0 * seed, 0), 3);
  round.drive(1, test::level_pose(0, 500, 0), 3);
  EXPECT_TRUE(round.find_all().empty());
  EXPECT_GT(round.finder.counters().implausible, 0U);
}

TEST(LoopFinder, FindsAnEarlierSessionsPlaceWhateverItsWorld) {
  LoopFinder finder({});
  const std::vector<MeshVertex> vertices = test::town(3).vertices;
  const std::vector<LoopKeyFrame> old_frames = {{100, Round::body(0, 1), 0, true}};
  finder.add_earlier({0, {}, vertices}, old_frames);
  // When the new session's world is turned and far off
  const Pose T_world_town = test::level_pose(2.1, -300, 70);
  const std::vector<LoopKeyFrame> frames = {{1, T_world_town * Round::body(0, 1), 0, true}};
  const auto turned = test::moved(vertices, {T_world_town.R, Eigen::Vector3d::Zero()});
  finder.add({1, {Eigen::Matrix3d::Identity(), T_world_town.p}, turned}, frames);
  const auto loops = finder.find();
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(loops[0].from, 100);
  EXPECT_LT(loops[0].T_from_to.p.norm(), 0.03);
  EXPECT_LT(Log(loops[0].T_from_to.R).norm(), 0.003);
}

TEST(LoopFinder, ACandidateStormIsBoundedNewestFirst) {
  LoopFinderConfig config;
  config.waiting_max = 5;
  config.verifications_per_call = 1;
  config.by_looks = 1;
  config.nearby_m = 0;
  config.loop_spacing_m = 0.5;
  Round round(config);
  for (int i = 0; i < 3; ++i) round.drive(1, {}, 2);
  round.drive(1, {}, 9);
  EXPECT_EQ(round.finder.waiting(), 5U);
  EXPECT_EQ(round.finder.counters().waiting_dropped, 6U + 4U);
  // One verification a call, of the newest
  const auto loops = round.finder.find();
  ASSERT_EQ(loops.size(), 1U);
  EXPECT_EQ(loops[0].to, 14);
  EXPECT_EQ(round.finder.waiting(), 4U);
  EXPECT_EQ(round.finder.counters().proposed, 1U);
}

TEST(LoopFinder, MemoryIsBoundedAndForgottenSurfacesAreFetched) {
  LoopFinderConfig config;
  config.memory.surfels_max = 1;  // only the newest sub-mesh's are kept
  config.memory.places_max = 8;
  for (const bool with_source : {false, true}) {
    Round round(config);
    const std::vector<MeshVertex> first = test::town(1).vertices;
    if (with_source)
      round.finder.set_source([&](std::int64_t id, std::vector<MeshVertex>& out) {
        out = id == 0 ? first : std::vector<MeshVertex>{};
        return id == 0;
      });
    for (std::uint32_t seed = 1; seed < 5; ++seed) round.drive(seed, test::level_pose(0, 5.0 * seed, 0), 3);
    EXPECT_TRUE(round.find_all().empty());
    round.drive(1, test::level_pose(0, 6, 0), 3);
    EXPECT_EQ(round.find_all().size(), with_source ? 1U : 0U);
    EXPECT_EQ(round.finder.counters().surfaces_gone > 0, !with_source);
    EXPECT_GT(round.finder.counters().forgotten, 0U);
  }
}

TEST(LoopFinder, SaysTheSameTwice) {
  std::vector<LoopMeasurement> loops[2];
  for (auto& found : loops) {
    Round round({});
    for (std::uint32_t seed = 1; seed < 5; ++seed) round.drive(seed, test::level_pose(0, 5.0 * seed, 0), 3);
    round.drive(1, test::level_pose(0, 7, 0), 3);
    found = round.find_all();
  }
  ASSERT_EQ(loops[0].size(), loops[1].size());
  ASSERT_FALSE(loops[0].empty());
  EXPECT_EQ(loops[0][0].T_from_to.p, loops[1][0].T_from_to.p);
  EXPECT_EQ(loops[0][0].covariance, loops[1][0].covariance);
}

}  // namespace
}  // namespace lxd::backend_loop_finder_test
