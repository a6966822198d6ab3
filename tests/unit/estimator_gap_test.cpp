// SPDX-License-Identifier: Apache-2.0
// Sweeps far apart: below, at and above the limit the prediction is what is documented, continuous at the limit, finite
// and bounded however long the gap, and the odometry goes on after it.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "estimator/ieskf.hpp"
#include "tests/support/room_sweeps.hpp"

namespace lxd::estimator_gap_test {
namespace {

using Eigen::Vector3d;
using test::kSweepSpan;

constexpr ConstantVelocityNoise kNoise{1.0, 2.0};
constexpr double kKnown_s = 1.0;
constexpr RateSigmas kUnknown{5.0, 1.0};
constexpr double kCentury_s = 3.2e9;

// A tracked carrier: pose and rates known well.
Ieskf tracked() {
  State x;
  x.v = {2, 0, 0};
  x.b_g = {0, 0, -0.5};
  StateMatrix P = StateMatrix::Zero();
  P.diagonal().head<kLidarDim>().setConstant(1e-4);
  Ieskf filter;
  filter.reset(x, P);
  return filter;
}

Ieskf after_gap(double span_s) {
  Ieskf filter = tracked();
  filter.predict_across({span_s, kKnown_s, kUnknown}, kNoise);
  return filter;
}

TEST(EstimatorGap, AtTheLimitHoldingIsThePlainPrediction) {
  Ieskf plain = tracked();
  plain.predict(kKnown_s, kNoise);
  const Ieskf held = after_gap(kKnown_s);
  EXPECT_LT(boxminus(held.state(), plain.state()).norm(), 1e-12);
  EXPECT_LT((held.covariance() - plain.covariance()).norm(), 1e-12);
}

TEST(EstimatorGap, JustAboveTheLimitNothingJumps) {
  Ieskf plain = tracked();
  plain.predict(kKnown_s, kNoise);
  const Ieskf held = after_gap(kKnown_s * (1 + 1e-6));
  EXPECT_LT(boxminus(held.state(), plain.state()).norm(), 1e-5);
  EXPECT_LT((held.covariance() - plain.covariance()).norm(), 1e-3);
}

TEST(EstimatorGap, TheRatesCarryThePoseOnNoLongerThanTheLimit) {
  for (const double span_s : {1.5, 10.0, 3600.0, kCentury_s}) {
    const State x = after_gap(span_s).state();
    EXPECT_LT((x.p - Vector3d(2 * kKnown_s, 0, 0)).norm(), 1e-12) << span_s;
    EXPECT_LT((Log(x.R) - Vector3d(0, 0, 0.5 * kKnown_s)).norm(), 1e-12) << span_s;
    EXPECT_NEAR(x.v.x(), 2 * kKnown_s / span_s, 1e-12) << span_s;
    EXPECT_NEAR(x.b_g.z(), -0.5 * kKnown_s / span_s, 1e-12) << span_s;
  }
}

TEST(EstimatorGap, TheDoubtGrowsToABound) {
  double before = 0;
  for (const double span_s : {1.0, 1.2, 1.6, 2.0}) {
    const double now = after_gap(span_s).covariance().trace();
    EXPECT_GT(now, before) << span_s;
    before = now;
  }
  const StateMatrix P = after_gap(kCentury_s).covariance();
  EXPECT_NEAR(P(kVelocity, kVelocity), 25, 1e-6);  // nothing is known of the rates any more
  EXPECT_NEAR(P(kGyroBias, kGyroBias), 1, 1e-6);
  EXPECT_NEAR(P(kPosition, kVelocity), 0, 1e-6);
  EXPECT_NEAR(P(kPosition, kPosition), 25 + 1.0 / 3 + 2e-4, 1e-6);
  EXPECT_LT(P(kTheta, kTheta), 1 + 4.0 / 3 + 1e-3);
}

TEST(EstimatorGap, TheCovarianceStaysSymmetricAndPositiveAndAnUpdateWorks) {
  for (const double span_s : {1.0 + 1e-9, 1.5, 60.0, kCentury_s, 1e300}) {
    Ieskf filter = after_gap(span_s);
    ASSERT_TRUE(filter.covariance().allFinite()) << span_s;
    EXPECT_EQ(test::asymmetry(filter.covariance()), 0) << span_s;
    EXPECT_GT(test::least_relative_eigenvalue(filter.covariance()), -1e-15) << span_s;
    NormalEquations sums;
    sums.information = 1e4 * LidarMatrix::Identity();
    filter.begin_update();
    filter.iterate(sums);
    EXPECT_TRUE(filter.conclude()) << span_s;
  }
}

// A carrier that is tracked for a second, then not seen for `gap_s` while it moves on at `during_mps`, then seen again.
struct Interrupted {
  Interrupted(double gap_s, double speed_mps, double during_mps) {
    State x;
    x.v = {speed_mps, 0, 0};
    std::int64_t begin_ns = 0;
    const auto look = [&] {
      outcomes[count++ % 2] = odometry->step(sweeps.next(x, begin_ns));
      x = propagate(x, kSweepSpan.seconds());
      begin_ns += kSweepSpan.ns();
    };
    for (int i = 0; i < 10; ++i) look();
    x.p.x() += during_mps * gap_s;
    begin_ns += Duration::from_seconds(gap_s).ns();
    for (int i = 0; i < 10; ++i) look();
    truth_m = x.p.x() - speed_mps * kSweepSpan.seconds();  // the world begins at the first sweep's end
  }
  [[nodiscard]] double error_m() const { return (odometry.odometry.state().p - Vector3d(truth_m, 0, 0)).norm(); }

  test::RoomSweeps sweeps;
  test::OwnedOdometry odometry;
  std::array<SweepOutcome, 2> outcomes;
  int count = 0;
  double truth_m = 0;
};

TEST(EstimatorGap, ACarrierThatGoesOnIsFoundAgainBelowAtAndAboveTheLimit) {
  // The time between the sweeps' ends is a sweep longer than the time without sweeps.
  for (const double gap_s : {0.3, 0.899, 0.9, 0.901, 1.5})
    EXPECT_LT(Interrupted(gap_s, 0.4, 0.4).error_m(), 0.05) << gap_s;
}

TEST(EstimatorGap, ACarrierThatStoodStillMeanwhileIsFoundAgain) {
  for (const double gap_s : {0.5, 2.0, 3600.0}) EXPECT_LT(Interrupted(gap_s, 0.3, 0.0).error_m(), 0.05) << gap_s;
}

TEST(EstimatorGap, ADecadeLeavesFiniteNumbers) {
  const Interrupted journey(3.2e8, 0.5, 0.0);
  EXPECT_TRUE(journey.odometry.odometry.state().p.allFinite());
  EXPECT_TRUE(journey.outcomes[1].covariance.allFinite());
  EXPECT_TRUE(journey.outcomes[1].tracked);
}

TEST(EstimatorGap, ADecadeBetweenTheFirstTwoSweepsLeavesFiniteNumbers) {
  test::RoomSweeps sweeps;
  test::OwnedOdometry odometry;
  odometry->step(sweeps.next(State{}, 0));
  const std::int64_t later_ns = Duration::from_seconds(3.2e8).ns();
  SweepOutcome outcome;
  for (int i = 0; i < 5; ++i) outcome = odometry->step(sweeps.next(State{}, later_ns + i * kSweepSpan.ns()));
  EXPECT_TRUE(outcome.T_world_body.p.allFinite());
  EXPECT_TRUE(outcome.covariance.allFinite());
  EXPECT_TRUE(outcome.tracked);
  EXPECT_LT(outcome.T_world_body.p.norm(), 0.05);
}

}  // namespace
}  // namespace lxd::estimator_gap_test
