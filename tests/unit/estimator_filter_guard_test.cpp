// SPDX-License-Identifier: Apache-2.0
// Updates that have no sound solution: rejected whole, the prediction kept, and the filter goes on.
#include <limits>

#include <gtest/gtest.h>

#include "estimator/ieskf.hpp"
#include "tests/support/wall_returns.hpp"

namespace lxd::estimator_filter_guard_test {
namespace {

using test::carrier;
using test::kNoise;
using test::kSigma_m;
using test::kSpan_s;
using test::kWide;
using test::plain;
using test::prior_covariance;
using test::residuals_at;
using test::StateChance;
using test::update;
using test::wall_sweep;

class BadNumbers : public testing::TestWithParam<double> {};

TEST_P(BadNumbers, AnUpdateWithThemIsRejectedAndThePredictionKept) {
  StateChance chance(54);
  Ieskf filter;
  filter.reset(carrier(chance), prior_covariance(0.1, 0.1, 0.1, 0.1));
  filter.predict(kSpan_s, kNoise);
  const State prediction = filter.state();
  const StateMatrix P = filter.covariance();
  // Given a good first iteration and a bad second one, in the gradient or in the information ...
  const auto returns = wall_sweep(prediction, 300, kSigma_m, chance);
  for (const bool in_gradient : {true, false}) {
    const auto spoiled = [&](const std::vector<PointResidual>& rs, int iteration) {
      NormalEquations sums = accumulate(rs, 1, kWide);
      if (iteration == 1) (in_gradient ? sums.gradient[2] : sums.information(2, 2)) = GetParam();
      return sums;
    };
    EXPECT_FALSE(update(filter, returns, spoiled, 3));
    // ... then state and covariance are the prediction's, and the next update works.
    EXPECT_EQ(boxminus(filter.state(), prediction).norm(), 0);
    EXPECT_EQ((filter.covariance() - P).norm(), 0);
  }
  EXPECT_TRUE(update(filter, returns, plain));
  EXPECT_LT(filter.covariance().trace(), P.trace());
}

INSTANTIATE_TEST_SUITE_P(EstimatorFilterGuard, BadNumbers,
                         testing::Values(std::numeric_limits<double>::quiet_NaN(),
                                         std::numeric_limits<double>::infinity(),
                                         -std::numeric_limits<double>::infinity()));

TEST(EstimatorFilterGuard, InformationThatIsNotPositiveIsRejected) {
  StateChance chance(55);
  Ieskf filter;
  const State x = carrier(chance);
  filter.reset(x, prior_covariance(0.1, 0.1, 0.1, 0.1));
  NormalEquations sums;
  sums.information(0, 0) = -1e6;
  filter.begin_update();
  filter.iterate(sums);
  EXPECT_FALSE(filter.conclude());
  EXPECT_EQ(boxminus(filter.state(), x).norm(), 0);
}

TEST(EstimatorFilterGuard, AnAbandonedUpdateLeavesThePrediction) {
  StateChance chance(56);
  Ieskf filter;
  const State x = carrier(chance);
  filter.reset(x, prior_covariance(0.1, 0.1, 0.1, 0.1));
  const StateMatrix P = filter.covariance();
  filter.begin_update();
  filter.iterate(accumulate(residuals_at(x, wall_sweep(x, 100, 1.0, chance)), 1, kWide));
  ASSERT_GT(boxminus(filter.state(), x).norm(), 1e-3);
  filter.abandon();
  EXPECT_EQ(boxminus(filter.state(), x).norm(), 0);
  EXPECT_EQ((filter.covariance() - P).norm(), 0);
}

}  // namespace
}  // namespace lxd::estimator_filter_guard_test
