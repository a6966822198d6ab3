// SPDX-License-Identifier: Apache-2.0
// Fixes tell how far odometry drifts, how long their own errors last and how far their stamps shake; and the graph
// weighs odometry and fixes by it.
#include <gtest/gtest.h>

#include "backend/graph/gnss_terms.hpp"
#include "tests/support/graph_story.hpp"

namespace lxd::backend_noise_levels_test {
namespace {

using test::GraphStory;

constexpr double kDelayExpected_s = 0.05, kDelaySigma_s = 0.05;

struct Conditions {
  double drift = 1;  // times what the settings say
  double sigma_m = 0.014;
  double correlation_s = 0;  // 0: white
  double white_share = 0.1;
  double multipath_m = 0;  // more errors, of 12 s, that the receiver says half of
  double jitter_s = 0;
  std::vector<Pose> path = test::wide_bends();  // a kilometre
  double speed_mps = 10;
  unsigned seed = 1;
  double delay_s = kDelayExpected_s;
};

// A path, and fixes with errors as the conditions say.
struct Drive {
  GraphStory story;
  std::vector<GnssMeasurement> fixes;
};

Drive drive(const Conditions& conditions) {
  Drive drive;
  GraphStory& story = drive.story;
  story.engine.seed(conditions.seed);
  story.earth.delay_s = conditions.delay_s;
  story.drive(conditions.path, {}, conditions.speed_mps, conditions.drift);
  const Eigen::Matrix3d R_enu_map = Exp(Eigen::Vector3d(0, 0, story.earth.yaw_rad));
  const double step_s = 2 / conditions.speed_mps;
  const double keep = conditions.correlation_s > 0 ? std::exp(-step_s / conditions.correlation_s) : 0;
  Eigen::Vector3d lasting = story.normals(1), multipath = story.normals(1);
  constexpr double kMultipath_s = 12;
  const double keep_multipath = std::exp(-step_s / kMultipath_s);
  for (int i = 0; i < static_cast<int>(story.truth.size()); ++i) {
    lasting = keep * lasting + story.normals(std::sqrt(1 - keep * keep));
    Eigen::Vector3d error_m = conditions.sigma_m * (std::sqrt(1 - conditions.white_share) * lasting +
                                                    story.normals(std::sqrt(conditions.white_share)));
    if (conditions.multipath_m > 0) {
      multipath = keep_multipath * multipath + story.normals(std::sqrt(1 - keep_multipath * keep_multipath));
      error_m += conditions.multipath_m * multipath;
    }
    const double said_m =
        std::sqrt(conditions.sigma_m * conditions.sigma_m + conditions.multipath_m * conditions.multipath_m / 4);
    GnssMeasurement fix = story.fix(i, said_m, error_m.cwiseProduct(Eigen::Vector3d(1, 1, 2)));
    fix.enu_m += story.normal(conditions.jitter_s) *
                 (R_enu_map * (story.truth[static_cast<std::size_t>(i)].R * fix.antenna_velocity_mps));
    drive.fixes.push_back(fix);
  }
  return drive;
}

NoiseLevels found_by(const Drive& drive) {
  OdometryChain chain({});
  for (const KeyFrame& frame : drive.story.key_frames) chain.add(frame);
  const Pose T_enu_world{Exp(Eigen::Vector3d(0, 0, drive.story.earth.yaw_rad)), drive.story.earth.offset_m};
  const auto levels = find_noise_levels(chain, drive.fixes, T_enu_world, kDelayExpected_s, kDelaySigma_s);
  EXPECT_TRUE(levels);
  return levels.value_or(NoiseLevels{});
}

double error_m(const Drive& drive) {
  PoseGraph graph({});
  for (std::size_t i = 0; i < drive.fixes.size(); ++i) {
    graph.add(drive.story.key_frames[i]);
    graph.add(drive.fixes[i]);
    graph.update();
  }
  graph.finish();
  EXPECT_GT(graph.gnss_counts().used, 9 * drive.fixes.size() / 10);
  return test::aligned_error_m(drive.story.truth, graph);
}

double odometry_error_m(const Drive& drive) {
  PoseGraph graph({});
  for (const KeyFrame& frame : drive.story.key_frames) graph.add(frame);
  return test::aligned_error_m(drive.story.truth, graph);
}

void expect_within(double found, double truth, double times) {
  EXPECT_GT(found, truth / times);
  EXPECT_LT(found, truth * times);
}

TEST(NoiseLevels, RtkTellsHowFarOdometryDrifts) {
  for (const double drift : {0.1, 1.0, 3.0}) {
    const NoiseLevels found = found_by(drive({.drift = drift}));
    expect_within(found.drift_horizontal, drift, 2);
    expect_within(found.drift_vertical, drift, 2);
  }
}

TEST(NoiseLevels, RtkTellsHowLongItsErrorsLast) {
  for (const double correlation_s : {1.0, 10.0, 40.0}) {
    const NoiseLevels found = found_by(drive({.drift = 0.1, .correlation_s = correlation_s}));
    expect_within(found.correlation_s, correlation_s, 3);
    expect_within(found.drift_horizontal, 0.1, 3);
  }
}

TEST(NoiseLevels, StampsThatShakeAreNoDrift) {
  const NoiseLevels found = found_by(drive({.drift = 0.1, .jitter_s = 0.01}));
  expect_within(found.jitter_s, 0.01, 2);
  expect_within(found.drift_horizontal, 0.1, 3);
}

// Fixes that are older than they are taken for lie behind, in another direction after each bend.
TEST(NoiseLevels, ADelayThatNobodyExpectedIsNoDrift) {
  EXPECT_FALSE(found_by(drive({.drift = 0, .delay_s = 0.15})).drift_shown());
}

// Half a minute on a car park.
std::vector<Pose> short_drive() {
  std::vector<Pose> path = test::wide_bends();
  path.resize(17);
  return path;
}

// Given a path that is good to a millimetre, and a few fixes of RTK, which are good to a centimetre, then it stays as
// it is, whatever their errors are.
TEST(NoiseLevels, AFewFixesOfCentimetresDoNotBendAPathOfMillimetres) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const Drive few = drive({.drift = 0.03, .correlation_s = 40, .path = short_drive(), .speed_mps = 1, .seed = seed});
    EXPECT_FALSE(found_by(few).drift_shown()) << seed;
    EXPECT_LT(error_m(few), 1.001 * odometry_error_m(few)) << seed;
  }
}

TEST(NoiseLevels, DriftIsShownWhereItIsLargerThanTheFixesErrors) {
  EXPECT_TRUE(found_by(drive({.drift = 0.3, .correlation_s = 40})).drift_shown());
  EXPECT_TRUE(found_by(drive({.drift = 3, .sigma_m = 0.3})).drift_shown());
  EXPECT_FALSE(found_by(drive({.drift = 0.3, .sigma_m = 1.5, .correlation_s = 40})).drift_shown());
}

// Given fixes of metres, which show nothing of centimetres of drift, then it stays near what was expected of it.
TEST(NoiseLevels, MetresTellNothingOfCentimetres) {
  const NoiseLevels found = found_by(drive({.drift = 0.1, .sigma_m = 1.5, .correlation_s = 40}));
  expect_within(found.drift_horizontal, 0.3, 2);
}

// Given a receiver of metres whose errors hardly jump from fix to fix, and among houses some reflections that it says
// half of, then nothing of that is taken for drift, and a path of centimetres stays as good as it is.
TEST(NoiseLevels, ErrorsThatAreHardlyWhiteAreNoDrift) {
  for (unsigned seed = 1; seed <= 2; ++seed)
    for (const double multipath_m : {0.0, 0.7}) {
      const Drive smooth = drive({.drift = 0.1,
                                  .sigma_m = 1.5,
                                  .correlation_s = 40,
                                  .white_share = 0.01,
                                  .multipath_m = multipath_m,
                                  .seed = seed});
      EXPECT_FALSE(found_by(smooth).drift_shown()) << seed << " " << multipath_m;
      EXPECT_LT(error_m(smooth), 1.1 * odometry_error_m(smooth)) << seed << " " << multipath_m;
    }
}

TEST(NoiseLevels, HowMuchOfTheErrorsIsWhiteIsFound) {
  for (const double white_share : {0.1, 0.01})
    EXPECT_EQ(found_by(drive({.drift = 0.1, .correlation_s = 40, .white_share = white_share})).white_share,
              white_share);
}

// Of many fixes some are taken, evenly: a longer drive shows no less than a shorter one.
TEST(NoiseLevels, OfMoreFixesThanCanBeJudgedSomeTellTheSame) {
  Drive all = drive({.drift = 1, .correlation_s = 10, .path = test::ring(1100, 1, 0.5)});
  ASSERT_GT(all.fixes.size(), 2048U);
  const NoiseLevels many = found_by(all);
  all.fixes.resize(2048);
  const NoiseLevels most = found_by(all);
  EXPECT_TRUE(many.drift_shown());
  EXPECT_GT(many.log_odds_of_drift, 0.9 * most.log_odds_of_drift);
}

TEST(NoiseLevels, AFewFixesTellNothing) {
  Drive few = drive({});
  few.fixes.resize(7);
  OdometryChain chain({});
  for (const KeyFrame& frame : few.story.key_frames) chain.add(frame);
  EXPECT_FALSE(find_noise_levels(chain, few.fixes, {}, 0, kDelaySigma_s));
  few.fixes.push_back(few.fixes.back());
  EXPECT_TRUE(find_noise_levels(chain, few.fixes, {}, 0, kDelaySigma_s));
}

// Given a path that is better than the fixes, then these do not spoil it; given one that drifts, then they hold it.
TEST(NoiseLevels, FixesHelpAPathThatDriftsAndSpoilNoneThatIsGood) {
  for (const unsigned seed : {1U, 2U})
    for (const double correlation_s : {0.0, 40.0}) {
      const Drive good = drive({.drift = 0.03, .correlation_s = correlation_s, .seed = seed});
      EXPECT_LT(error_m(good), 1.1 * odometry_error_m(good)) << correlation_s;
      const Drive poor = drive({.drift = 1, .correlation_s = correlation_s, .seed = seed});
      EXPECT_LT(error_m(poor), 0.2 * odometry_error_m(poor)) << correlation_s;
    }
}

}  // namespace
}  // namespace lxd::backend_noise_levels_test
