// SPDX-License-Identifier: Apache-2.0
// The evaluation of paths finds known answers: what was put in as error comes out as error, and nothing else.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "rt/so3.hpp"
#include "tests/support/evaluation.hpp"
#include "tools/evaluate/align.hpp"
#include "tools/evaluate/trajectory_errors.hpp"

namespace lxd::evaluate_trajectory_test {
namespace {

using test::changed;
using test::Evaluation;
using test::helix;
using test::rigid;
using test::straight;

TEST_F(Evaluation, AnotherWorldFrameIsNoError) {
  const Pose T = rigid(2.1, {1, -2, 0.5}, {100, -50, 7});
  const auto report =
      run(changed(helix(500), [&](StampedPose& pose, std::size_t) { pose.T = T * pose.T; }), helix(500));
  EXPECT_EQ(report.matched, 500U);
  EXPECT_LT(report.ate_m.max, 1e-7);
  EXPECT_LT(report.orientation_rad->max, 1e-7);
  EXPECT_LT(report.relative.at(0).translation_m.max, 1e-7);
  EXPECT_LT(report.final_drift_m, 1e-7);
}

TEST_F(Evaluation, ScaleIsAnError) {
  const auto report =
      run(changed(straight(101, 1), [](StampedPose& pose, std::size_t) { pose.T.p *= 1.02; }), straight(101, 1));
  // The residual of a line stretched by 2 % about its middle: 0.02 * |x|, whose rms is 0.02 * 100 / sqrt(12).
  EXPECT_NEAR(report.ate_m.rmse, 0.02 * std::sqrt((101.0 * 101 - 1) / 12), 1e-6);
  EXPECT_NEAR(report.ate_m.max, 1.0, 1e-6);
  EXPECT_NEAR(report.kitti->translation_ratio, 0.02, 1e-6);
  EXPECT_NEAR(report.relative.at(0).translation_m.mean, 0.02, 1e-6);
  EXPECT_NEAR(report.final_drift_m, 2.0, 1e-6);
}

TEST_F(Evaluation, NoiseComesOutAsLargeAsItWentIn) {
  std::mt19937 random(1);
  std::normal_distribution<double> noise(0, 0.05);
  const auto estimate = changed(helix(2000), [&](StampedPose& pose, std::size_t) {
    pose.T.p += Eigen::Vector3d(noise(random), noise(random), noise(random));
  });
  EXPECT_NEAR(run(estimate, helix(2000)).ate_m.rmse, 0.05 * std::sqrt(3.0), 0.003);
}

TEST_F(Evaluation, YawDriftIsFoundPerMetre) {
  const double drift_rad_per_m = 0.001;
  const auto estimate = changed(straight(301, 1), [&](StampedPose& pose, std::size_t i) {
    pose.T.R = Eigen::AngleAxisd(drift_rad_per_m * static_cast<double>(i), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  });
  const auto report = run(estimate, straight(301, 1));
  EXPECT_NEAR(report.kitti->rotation_rad_per_m, drift_rad_per_m, 1e-9);
  EXPECT_EQ(report.kitti->lengths.front().length_m, 100);
  EXPECT_EQ(report.kitti->lengths.front().segments, 21U) << "begun at every tenth pose, as KITTI does";
  EXPECT_NEAR(report.relative.at(1).rotation_rad->mean, 10 * drift_rad_per_m, 1e-9);
}

TEST_F(Evaluation, ShortPathIsMeasuredOverShortSegments) {
  EXPECT_EQ(run(straight(701, 0.1), straight(701, 0.1)).kitti->lengths.front().length_m, 10);
  EXPECT_EQ(run(straight(71, 0.1), straight(71, 0.1)).kitti->lengths.front().length_m, 1);
}

TEST_F(Evaluation, TruthIsInterpolatedAtTheEstimatesStamps) {
  const auto estimate = changed(straight(100, 0.5), [](StampedPose& pose, std::size_t) {
    pose.stamp = pose.stamp + Duration::from_ns(30'000'000);
    pose.T.p.x() += 0.15;
  });
  const auto report = run(estimate, straight(100, 0.5));
  EXPECT_EQ(report.matched, 99U);
  EXPECT_EQ(report.unmatched, 1U) << "the last one lies beyond truth";
  EXPECT_LT(report.ate_m.max, 1e-8);
  EXPECT_LT(report.final_drift_m, 1e-8);
}

TEST_F(Evaluation, TruthIsNotInterpolatedOverAGap) {
  auto truth = straight(100, 0.5);
  truth.erase(truth.begin() + 40, truth.begin() + 60);
  const auto report = run(straight(100, 0.5), truth);
  EXPECT_EQ(report.matched, 80U);
  EXPECT_EQ(report.unmatched, 20U);
}

TEST_F(Evaluation, StraightAndStandingPathsTakeTheirRollFromTheOrientations) {
  const Pose T = rigid(1.3, {0.3, 1, 2}, {5, 6, 7});
  for (const double step_m : {0.5, 0.0}) {
    const auto report =
        run(changed(straight(100, step_m), [&](StampedPose& pose, std::size_t) { pose.T = T * pose.T; }),
            straight(100, step_m));
    EXPECT_LT(report.orientation_rad->max, 1e-6);
    EXPECT_LT(report.ate_m.max, 1e-7);
  }
}

TEST_F(Evaluation, PrismTruthWithoutAttitudeGivesPositionsOnly) {
  std::string text;
  for (const StampedPose& pose : helix(100)) {
    const std::string line = tum_line(pose);
    std::size_t end = 0;
    for (int word = 0; word < 4; ++word) end = line.find(' ', end + 1);
    text += line.substr(0, end) + " 0 0 0 0\n";
  }
  test::write_file(folder_ / "truth.tum", text);
  ASSERT_TRUE(write_trajectory(folder_ / "estimate.tum", helix(100)).ok());
  const auto report = evaluate(options());
  ASSERT_TRUE(report.ok()) << report.error().message;
  EXPECT_LT(report->ate_m.max, 1e-7);
  EXPECT_FALSE(report->orientation_rad.has_value());
  EXPECT_TRUE(report->relative.empty());
  EXPECT_FALSE(to_json(*report).contains("orientation_deg"));
}

TEST_F(Evaluation, PathsOfDifferentDaysSaySo) {
  ASSERT_TRUE(write_trajectory(folder_ / "estimate.tum", straight(10, 1)).ok());
  ASSERT_TRUE(write_trajectory(folder_ / "truth.tum", helix(10)).ok());
  const auto report = evaluate(options());
  ASSERT_FALSE(report.ok());
  EXPECT_NE(report.error().message.find("0 of 10 poses"), std::string::npos);
}

TEST_F(Evaluation, MeshWithoutWorldIsBadUsage) {
  EvaluateOptions lone = options();
  lone.mesh = "mesh.ply";
  EXPECT_FALSE(evaluate(lone).ok());
}

TEST_F(Evaluation, ARigIsOfUseWithAMeshOnly) {
  EvaluateOptions lone = options();
  lone.rig = "rig.yaml";
  const auto report = evaluate(lone);
  ASSERT_FALSE(report.ok());
  EXPECT_NE(report.error().message.find("--rig"), std::string::npos);
}

TEST_F(Evaluation, TableAndJsonTellTheSame) {
  const auto report =
      run(changed(straight(301, 1), [](StampedPose& pose, std::size_t) { pose.T.p *= 1.01; }), straight(301, 1));
  const std::string table = to_table(report);
  EXPECT_NE(table.find("position m"), std::string::npos);
  EXPECT_NE(table.find("1.0000"), std::string::npos) << "per cent of KITTI";
  const auto json = to_json(report);
  EXPECT_DOUBLE_EQ(json["ate_m"]["rmse"].get<double>(), report.ate_m.rmse);
  EXPECT_NEAR(json["kitti"]["translation_percent"].get<double>(), 1.0, 1e-6);
}

TEST(SummaryOfValues, KnownAnswers) {
  const Statistics s = summarise({4, 1, 3, 2});
  EXPECT_DOUBLE_EQ(s.mean, 2.5);
  EXPECT_DOUBLE_EQ(s.median, 2.5);
  EXPECT_DOUBLE_EQ(s.rmse, std::sqrt(7.5));
  EXPECT_DOUBLE_EQ(s.max, 4);
  EXPECT_NEAR(s.p95, 3.85, 1e-12);
  EXPECT_EQ(summarise({}).count, 0U);
}

TEST(Alignment, MirrorImageIsNotAlignedAway) {
  std::vector<PosePair> pairs;
  for (const StampedPose& pose : helix(300)) {
    PosePair pair{pose.stamp, pose.T, pose.T};
    pair.estimate.p.z() *= -1;
    pairs.push_back(pair);
  }
  const Pose T = align_path(pairs, 0);
  EXPECT_NEAR(T.R.determinant(), 1, 1e-9);
  EXPECT_GT(absolute_errors(pairs, T).rmse, 0.1);
}

// Given a straight path whose positions err by millimetres and whose orientations are exact; then the lever of a mesh
// holds the roll that the positions would turn by degrees.
TEST(Alignment, AboutAStraightPathTheOrientationsHoldTheRollOfAMesh) {
  std::vector<PosePair> pairs;
  for (int i = 0; i < 200; ++i) {
    PosePair pair;
    pair.truth.p = {0.1 * i, 0.002 * std::sin(i), 0};
    pair.estimate.p = {0.1 * i, 0, 0.002 * std::sin(i)};  // as if rolled by a right angle
    pairs.push_back(pair);
  }
  const auto roll_rad = [&](double lever_m) { return std::abs(Log(align_path(pairs, lever_m).R).x()); };
  EXPECT_GT(roll_rad(0), 1.5);
  EXPECT_LT(roll_rad(kMeshLever_m), 1e-5);
}

}  // namespace
}  // namespace lxd::evaluate_trajectory_test
