// SPDX-License-Identifier: Apache-2.0
// NEES and NIS: a filter that is as sure as it should be passes, one that is too sure is found out.
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "tests/support/evaluation.hpp"
#include "tools/evaluate/consistency.hpp"

namespace lxd::evaluate_consistency_test {
namespace {

using test::changed;
using test::Evaluation;
using test::helix;

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

}  // namespace
}  // namespace lxd::evaluate_consistency_test
