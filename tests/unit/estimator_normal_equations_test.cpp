// SPDX-License-Identifier: Apache-2.0
// The robust sums: equal to a dense reference, and what scale and kernel make of outliers.
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/normal_equations.hpp"
#include "tests/support/estimator_states.hpp"
#include "tests/support/property.hpp"

namespace lxd::estimator_normal_equations_test {
namespace {

using test::check_property;
using test::StateChance;

constexpr double kWide = 1e9;  // sigmas: a kernel that weighs every residual by one

StateChance any_chance() { return StateChance(*rc::gen::arbitrary<unsigned>()); }

std::vector<PointResidual> residuals(StateChance& chance, int count, double sigmas = 1.0) {
  std::vector<PointResidual> out(count);
  for (PointResidual& r : out) {
    r.variance_m2 = std::pow(chance.uniform(0.01, 0.1), 2);
    r.r_m = chance.normal(sigmas * std::sqrt(r.variance_m2));
    for (int i = 0; i < kLidarDim; ++i) r.row[i] = chance.normal(2);
  }
  return out;
}

double scale_of(const std::vector<PointResidual>& rs) {
  std::vector<float> scratch(rs.size());
  return residual_scale(rs, scratch);
}

TEST(EstimatorNormalEquations, TheSumsEqualADenseReference) {
  check_property(
      [] {
        // Given H, W and r as whole matrices, the kernel's weight by its definition (k^2 / (k^2 + x^2))^2 ...
        StateChance chance = any_chance();
        const int count = 1 + static_cast<int>(chance.uniform(0, 100));
        const auto rs = residuals(chance, count, 3);
        const double scale = chance.uniform(1, 3), kernel = chance.uniform(1, 10);
        Eigen::MatrixXd H(count, kLidarDim);
        Eigen::VectorXd r(count), w(count);
        for (int i = 0; i < count; ++i) {
          H.row(i) = rs[i].row.transpose();
          r[i] = rs[i].r_m;
          const double x2 = r[i] * r[i] / (scale * scale * rs[i].variance_m2);
          w[i] = std::pow(kernel * kernel / (kernel * kernel + x2), 2) / (scale * scale * rs[i].variance_m2);
        }
        // ... then the sums are H^T W H, H^T W r and the trace of W.
        const NormalEquations sums = accumulate(rs, scale, kernel);
        const Eigen::MatrixXd information = H.transpose() * w.asDiagonal() * H;
        const Eigen::VectorXd gradient = H.transpose() * w.asDiagonal() * r;
        RC_ASSERT((sums.information - information).norm() <= 1e-12 * information.norm());
        RC_ASSERT((sums.gradient - gradient).norm() <= 1e-12 * (H.transpose() * w.asDiagonal()).norm() * r.norm());
        RC_ASSERT(std::abs(sums.weight - w.sum()) <= 1e-12 * w.sum());
      },
      200);
}

TEST(EstimatorNormalEquations, NothingSumsToNothing) {
  const NormalEquations sums = accumulate({}, 1, kWide);
  EXPECT_EQ(sums.information.norm(), 0);
  EXPECT_EQ(sums.gradient.norm(), 0);
  EXPECT_EQ(sums.weight, 0);
  EXPECT_EQ(residual_scale({}, {}), 1);
}

TEST(EstimatorNormalEquations, ResidualsAsGoodAsTheirSigmasHaveScaleOne) {
  StateChance chance(31);
  EXPECT_NEAR(scale_of(residuals(chance, 20'000)), 1.0, 0.02);
}

TEST(EstimatorNormalEquations, ResidualsBetterThanTheirSigmasAreNotTrustedMore) {
  StateChance chance(32);
  EXPECT_EQ(scale_of(residuals(chance, 1000, 0.2)), 1.0);
  EXPECT_EQ(scale_of(residuals(chance, 1000, 0)), 1.0);
}

TEST(EstimatorNormalEquations, ResidualsThreeTimesWorseHaveScaleThree) {
  StateChance chance(33);
  EXPECT_NEAR(scale_of(residuals(chance, 20'000, 3.0)), 3.0, 0.06);
}

// The median of |x| moves to the (0.5 / 0.7) quantile of the good: 1.0676 sigma, times 1.4826.
TEST(EstimatorNormalEquations, ThreeInTenOutliersAsFarAsYouLikeMoveTheScaleByAKnownAmount) {
  StateChance chance(34);
  auto rs = residuals(chance, 20'000);
  for (std::size_t i = 0; i < rs.size() * 3 / 10; ++i) rs[i].r_m = 1e6;
  EXPECT_NEAR(scale_of(rs), 1.4826 * 1.0676, 0.04);
}

TEST(EstimatorNormalEquations, TheScaleIsTheUpperMedianByHand) {
  std::vector<PointResidual> rs(4);
  for (int i = 0; i < 4; ++i) rs[i] = {(i % 2 == 0 ? 1 : -1) * 2.0 * (i + 1), 1.0, LidarVector::Zero(), 0};
  EXPECT_NEAR(scale_of(rs), 1.4826 * 6, 1e-6);  // |r|: 2 4 6 8
}

TEST(EstimatorNormalEquations, AnOutlierPullsLessTheFartherItIs) {
  const auto pull = [](double sigmas) {
    const std::array<PointResidual, 1> one{{{sigmas, 1.0, LidarVector::Ones(), 0}}};
    return accumulate(one, 1, 2.5).gradient[0];
  };
  EXPECT_NEAR(pull(2.5), 2.5 / 4, 1e-12);          // at the kernel: a quarter of its weight
  EXPECT_GT(pull(2.5 / std::sqrt(3)), pull(2.5));  // the largest pull is at k / sqrt 3
  EXPECT_GT(pull(2.5 / std::sqrt(3)), pull(1.3));
  EXPECT_LT(pull(100), 1e-4);
}

// A plane's offset from 2000 points, three in ten 50 sigma off on one side: the answer is the good ones'.
TEST(EstimatorNormalEquations, OutliersOfOneSideHardlyMoveTheSolution) {
  StateChance chance(35);
  std::vector<PointResidual> rs(2000);
  double moved = 0;
  for (int iteration = 0; iteration < 15; ++iteration) {
    StateChance same(36);
    for (std::size_t i = 0; i < rs.size(); ++i)
      rs[i] = {(i % 10 < 3 ? 1.0 : same.normal(0.02)) + moved, 4e-4, LidarVector::Unit(kPosition), 0};
    const NormalEquations sums = accumulate(rs, scale_of(rs), kernel_sigmas(iteration));
    moved -= sums.gradient[kPosition] / sums.information(kPosition, kPosition);
  }
  EXPECT_LT(std::abs(moved), 0.003);  // 0.3 m would be the plain mean's error
}

TEST(EstimatorNormalEquations, TheKernelNarrowsFromEightSigmasToTwoAndAHalf) {
  EXPECT_EQ(kernel_sigmas(0), 8);
  for (int i = 0; i < 20; ++i) EXPECT_LE(kernel_sigmas(i + 1), kernel_sigmas(i));
  EXPECT_GT(kernel_sigmas(2), 2.5);
  EXPECT_EQ(kernel_sigmas(3), 2.5);
  EXPECT_EQ(kernel_sigmas(50), 2.5);
}

}  // namespace
}  // namespace lxd::estimator_normal_equations_test
