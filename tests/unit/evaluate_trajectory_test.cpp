// SPDX-License-Identifier: Apache-2.0
// The evaluation of paths finds known answers: what was put in as error comes out as error, and nothing else.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "backend/trajectory_writer.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/evaluate/align.hpp"
#include "tools/evaluate/consistency.hpp"
#include "tools/evaluate/evaluate.hpp"
#include "tools/evaluate/trajectory_errors.hpp"

namespace lxd {
namespace {

using test::TemporaryFolder;

Pose rigid(double angle_rad, const Eigen::Vector3d& axis, const Eigen::Vector3d& p) {
  return {Eigen::AngleAxisd(angle_rad, axis.normalized()).toRotationMatrix(), p};
}

// A climbing helix at 10 Hz: every direction of position and attitude is excited.
std::vector<StampedPose> helix(int count) {
  std::vector<StampedPose> path;
  for (int i = 0; i < count; ++i) {
    const double a = 0.02 * i;
    path.push_back({RigTime::from_ns(1'700'000'000'000'000'000 + i * 100'000'000LL),
                    rigid(a, {0.1, 0.2, 1}, {10 * std::cos(a), 10 * std::sin(a), 0.5 * std::sin(3 * a)})});
  }
  return path;
}

std::vector<StampedPose> straight(int count, double step_m) {
  std::vector<StampedPose> path;
  for (int i = 0; i < count; ++i)
    path.push_back({RigTime::from_ns(i * 100'000'000LL), {Eigen::Matrix3d::Identity(), {i * step_m, 0, 0}}});
  return path;
}

template <typename Change>
std::vector<StampedPose> changed(std::vector<StampedPose> path, Change change) {
  for (std::size_t i = 0; i < path.size(); ++i) change(path[i], i);
  return path;
}

class Evaluation : public ::testing::Test {
 protected:
  EvaluationReport run(const std::vector<StampedPose>& estimate, const std::vector<StampedPose>& truth) {
    EXPECT_TRUE(write_trajectory(folder_ / "estimate.tum", estimate).ok());
    EXPECT_TRUE(write_trajectory(folder_ / "truth.tum", truth).ok());
    const auto report = evaluate(options());
    EXPECT_TRUE(report.ok()) << (report.ok() ? "" : report.error().message);
    return report.ok() ? *report : EvaluationReport{};
  }
  EvaluateOptions options() {
    EvaluateOptions options;
    options.estimate = folder_ / "estimate.tum";
    options.truth = folder_ / "truth.tum";
    return options;
  }
  TemporaryFolder folder_;
};

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

// A random walk whose increments have a known covariance: the filter that says so is consistent, one that claims less
// is not.
class Nees : public Evaluation {
 protected:
  Consistency run_with(double claimed_factor) {
    std::mt19937 random(5);
    std::normal_distribution<double> noise(0, 1);
    constexpr double kPosition_m = 0.02, kRotation_rad = 0.01;
    // Independent errors at every pose but the first, which fixes the gauge.
    const auto truth = helix(1500);
    const auto estimate = changed(truth, [&](StampedPose& pose, std::size_t i) {
      if (i == 0) return;
      const Eigen::Vector3d r = kRotation_rad * Eigen::Vector3d(noise(random), noise(random), noise(random));
      pose.T.R = pose.T.R * Eigen::AngleAxisd(-r.norm(), r.normalized()).toRotationMatrix();
      pose.T.p -= kPosition_m * Eigen::Vector3d(noise(random), noise(random), noise(random));
    });
    PoseCovariance covariance = PoseCovariance::Zero();
    covariance.diagonal().head<3>().setConstant(claimed_factor * kRotation_rad * kRotation_rad);
    covariance.diagonal().tail<3>().setConstant(claimed_factor * kPosition_m * kPosition_m);
    std::string text;
    for (const StampedPose& pose : estimate) text += covariance_line(pose.stamp, covariance);
    test::write_file(folder_ / "estimate_covariance.txt", text);
    return run(estimate, truth).consistency.value();
  }
};

TEST_F(Nees, HonestFilterLiesWithinTheBounds) {
  const Consistency c = run_with(1);
  EXPECT_EQ(c.poses, 1499U);
  EXPECT_EQ(c.skipped, 0U);
  EXPECT_GT(c.nees_pose, c.lower_95);
  EXPECT_LT(c.nees_pose, c.upper_95);
  EXPECT_NEAR(c.nees_rotation, 3, 0.2);
  EXPECT_NEAR(c.nees_position, 3, 0.2);
  EXPECT_NEAR(c.share_within_95, 0.95, 0.02);
}

TEST_F(Nees, OverconfidentFilterIsFoundOut) {
  const Consistency c = run_with(0.25);
  EXPECT_NEAR(c.nees_pose, 24, 1.5);
  EXPECT_GT(c.nees_pose, c.upper_95);
}

TEST_F(Nees, SingularCovarianceIsSkippedAndCounted) {
  const Consistency c = run_with(0);
  EXPECT_EQ(c.poses, 0U);
  EXPECT_EQ(c.skipped, 1499U);
}

// Updates whose NIS is drawn as that of a consistent filter, times `factor`.
class Nis : public Evaluation {
 protected:
  void write_innovations(double factor) {
    std::mt19937 random(6);
    std::chi_squared_distribution<double> squared(12);
    std::string text;
    for (const StampedPose& pose : helix(1500)) text += innovation_line(pose.stamp, factor * squared(random), 12);
    test::write_file(folder_ / "estimate_innovation.txt", text);
  }
};

TEST_F(Nis, OfAConsistentFilterIsOneADimension) {
  write_innovations(1);
  const auto report = run(helix(1500), helix(1500));
  ASSERT_TRUE(report.innovation.has_value());
  const InnovationConsistency& c = *report.innovation;
  EXPECT_EQ(c.updates, 1500U);
  EXPECT_GT(c.nis_per_dimension, c.lower_95);
  EXPECT_LT(c.nis_per_dimension, c.upper_95);
  EXPECT_NEAR(c.share_within_95, 0.95, 0.02);
  EXPECT_EQ(report.innovations.size(), 1500U);
  EXPECT_NE(to_table(report).find("NIS"), std::string::npos);
  EXPECT_EQ(to_json(report)["nis"]["updates"], 1500);
}

TEST_F(Nis, OfAnOverconfidentFilterIsFoundOut) {
  write_innovations(2);
  const auto report = run(helix(1500), helix(1500));
  EXPECT_NEAR(report.innovation->nis_per_dimension, 2, 0.1);
  EXPECT_GT(report.innovation->nis_per_dimension, report.innovation->upper_95);
  EXPECT_LT(report.innovation->share_within_95, 0.6);
}

TEST_F(Nis, ADamagedFileIsNamed) {
  for (const char* const line : {"5 -1 12\n", "5 3 0\n", "5 3 1.5\n", "5 3\n"}) {
    test::write_file(folder_ / "estimate_innovation.txt", line);
    ASSERT_TRUE(write_trajectory(folder_ / "estimate.tum", helix(10)).ok());
    ASSERT_TRUE(write_trajectory(folder_ / "truth.tum", helix(10)).ok());
    const auto report = evaluate(options());
    ASSERT_FALSE(report.ok()) << line;
    EXPECT_NE(report.error().message.find("estimate_innovation.txt:1: found"), std::string::npos);
  }
}

TEST(ChiSquared, QuantilesAgreeWithTables) {
  EXPECT_NEAR(chi_squared_quantile(6, 1.959964), 14.449, 0.02);
  EXPECT_NEAR(chi_squared_quantile(100, -1.959964), 74.222, 0.05);
  EXPECT_NEAR(chi_squared_quantile(100, 1.959964), 129.561, 0.05);
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
  const Pose T = align_path(pairs, false);
  EXPECT_NEAR(T.R.determinant(), 1, 1e-9);
  EXPECT_GT(absolute_errors(pairs, T).rmse, 0.1);
}

}  // namespace
}  // namespace lxd
