// SPDX-License-Identifier: Apache-2.0
// The odometry in a simulated room: at rest, moving, and with sweeps that are empty, thin, late or bad.
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/room_journey.hpp"

namespace lxd::estimator_odometry_test {
namespace {

using Eigen::Vector3d;
using test::Journey;
using test::kSweepSpan;
using test::moving;

constexpr std::int64_t kPeriod_ns = kSweepSpan.ns();

TEST(EstimatorOdometry, AtRestItStays) {
  Journey journey(State{});
  Vector3d speeds = Vector3d::Zero();
  for (int i = 0; i < 30; ++i) {
    const SweepOutcome& outcome = journey.sweep();
    speeds += journey.odometry->state().v / 30;
    ASSERT_EQ(outcome.rejection, SweepRejection::none);
    EXPECT_EQ(outcome.tracked, i > 0);
    EXPECT_LT(journey.shift_error_m(outcome.T_world_body), 0.01) << i;
    EXPECT_LT(journey.turn_error_rad(outcome.T_world_body), 0.003) << i;
  }
  // One sweep's acceleration leaves 0.3 m/s of doubt; what is measured of it scatters by 0.1 m/s an axis and has no
  // bias: the mean of 30 is longer than 0.1 / sqrt(30) * sqrt(16.3) once in a thousand times.
  EXPECT_LT(journey.odometry->state().v.norm(), 0.4);
  EXPECT_LT(speeds.norm(), 0.074);
}

TEST(EstimatorOdometry, ASteadyMotionIsFollowedWithItsRates) {
  Journey journey(moving({0.8, -0.4, 0.1}, {0, 0.05, 0.4}));
  SweepOutcome last;
  for (int i = 0; i < 30; ++i) last = journey.sweep();
  EXPECT_TRUE(last.tracked);
  EXPECT_EQ(last.degenerate_directions, 0);
  EXPECT_LT(journey.shift_error_m(last.T_world_body), 0.03);
  EXPECT_LT(journey.turn_error_rad(last.T_world_body), 0.006);
  EXPECT_NEAR(journey.odometry->state().v.norm(), 0.9, 0.05);
  EXPECT_LT((journey.odometry->state().b_g + Vector3d(0, 0.05, 0.4)).norm(), 0.03);
}

TEST(EstimatorOdometry, AnEmptyFirstSweepIsNoBeginning) {
  Journey journey(State{});
  EXPECT_EQ(journey.sweep_of({}).rejection, SweepRejection::too_few_points);
  EXPECT_TRUE(journey.odometry->map().empty());
  // The next one with points defines the world.
  EXPECT_EQ(journey.sweep().rejection, SweepRejection::none);
  EXPECT_TRUE(journey.sweep().tracked);
}

TEST(EstimatorOdometry, AnEmptySweepOnTheWayIsToldAndBridgedByThePrediction) {
  Journey journey(moving({0.8, 0, 0}, {0, 0, 0.3}));
  for (int i = 0; i < 10; ++i) journey.sweep();
  const State before = journey.odometry->state();
  EXPECT_EQ(journey.sweep_of({}).rejection, SweepRejection::too_few_points);
  EXPECT_EQ(boxminus(journey.odometry->state(), before).norm(), 0);
  const SweepOutcome& next = journey.sweep();
  EXPECT_TRUE(next.tracked);
  EXPECT_LT(journey.shift_error_m(next.T_world_body), 0.03);
  EXPECT_LT(journey.turn_error_rad(next.T_world_body), 0.006);
}

TEST(EstimatorOdometry, ASweepOfOnePointIsNoSweep) {
  Journey journey(State{});
  for (int i = 0; i < 5; ++i) journey.sweep();
  EXPECT_EQ(journey.sweep_of({{3, 0, 0, 1, 0}}).rejection, SweepRejection::too_few_points);
  EXPECT_TRUE(journey.sweep().tracked);
}

// Only usable returns make a sweep: thirty of them are enough, one fewer is not.
TEST(EstimatorOdometry, ThirtyUsableReturnsMakeASweep) {
  const auto rejection_of = [](int good) {
    Journey journey(State{});
    std::vector<LidarPoint> points(1000, {std::numeric_limits<float>::quiet_NaN(), 1, 1, 1, 0});
    for (int i = 0; i < good; ++i) points[30 * i] = {3, 0.1F * static_cast<float>(i), 1, 1, 0};
    return journey.sweep_of(points).rejection;
  };
  EXPECT_EQ(rejection_of(29), SweepRejection::too_few_points);
  EXPECT_EQ(rejection_of(30), SweepRejection::none);
  EXPECT_EQ(rejection_of(31), SweepRejection::none);
}

// Enough returns, but none near a surface that is known: the pose is the prediction, the rates go on, doubt grows.
TEST(EstimatorOdometry, ASweepThatSeesNothingKnownKeepsThePrediction) {
  Journey journey(moving({0.8, 0, 0}));
  for (int i = 0; i < 10; ++i) journey.sweep();
  const State predicted = propagate(journey.odometry->state(), 0.1);
  const double doubt = journey.odometry->step(journey.sweeps.next(journey.truth, journey.begin_ns)).covariance.trace();
  journey.pass(kPeriod_ns);
  std::vector<LidarPoint> far;
  for (int i = 0; i < 100; ++i) far.push_back({60.0F + 0.3F * static_cast<float>(i), 20, 10, 1, 0});
  const SweepOutcome& outcome = journey.sweep_of(far);
  EXPECT_EQ(outcome.rejection, SweepRejection::none);
  EXPECT_FALSE(outcome.tracked);
  EXPECT_LT((outcome.T_world_body.p - propagate(predicted, 0.1).p).norm(), 0.02);
  EXPECT_GT(outcome.covariance.trace(), 2 * doubt);
}

std::vector<LidarPoint> noise(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> spread(0, 3);
  std::vector<LidarPoint> points;
  for (int i = 0; i < 4000; ++i) points.push_back({spread(random), spread(random), spread(random), 1, 0});
  return points;
}

// Given a LiDAR that sends noise for three sweeps; then no surface is made of it, the pose is carried on by the motion,
// and the next good sweep is where it should be.
TEST(EstimatorOdometry, SweepsOfNoiseMoveNothingAndLeaveNothing) {
  Journey journey(moving({0.5, 0, 0}));
  for (int i = 0; i < 10; ++i) journey.sweep();
  const std::uint32_t layers = journey.odometry->map().window(0).layer_count();
  for (unsigned i = 0; i < 3; ++i) {
    const SweepOutcome& outcome = journey.sweep_of(noise(i));
    EXPECT_FALSE(outcome.tracked) << outcome.agreement;
    EXPECT_TRUE(outcome.registered.empty());
  }
  EXPECT_EQ(journey.odometry->map().window(0).layer_count(), layers);
  const SweepOutcome& after = journey.sweep();
  EXPECT_TRUE(after.tracked);
  EXPECT_GT(after.agreement, 0.9);
  EXPECT_LT(journey.shift_error_m(after.T_world_body), 0.02);
}

// Given nothing but what does not fit the map; then it is mapped in the end, for it might be another place.
TEST(EstimatorOdometry, WhatIsSeenForLongEnoughIsMapped) {
  constexpr unsigned kLostSweepsMax = 10;
  Journey journey(moving({0, 0, 0}));
  for (int i = 0; i < 5; ++i) journey.sweep();
  for (unsigned i = 0; i < kLostSweepsMax + 2; ++i)
    EXPECT_EQ(journey.sweep_of(noise(i)).registered.empty(), i < kLostSweepsMax) << i;
}

// Given a first sweep that is noise, or a pause after it that no motion bridges; then the next one begins the world.
TEST(EstimatorOdometry, ABadBeginningIsBegunAgain) {
  Journey noisy(moving({0.5, 0, 0})), paused(moving({0.5, 0, 0}));
  noisy.sweep_of(noise(1));
  EXPECT_FALSE(noisy.sweep().tracked);
  EXPECT_TRUE(noisy.sweep().tracked);
  paused.sweep();
  paused.pass(5'000'000'000);
  EXPECT_FALSE(paused.sweep().tracked);
  const Eigen::Vector3d begin = paused.odometry->state().p;
  EXPECT_EQ(begin, Eigen::Vector3d::Zero());
  EXPECT_TRUE(paused.sweep().tracked);
  EXPECT_NEAR((paused.odometry->state().p - begin).norm(), 0.05, 0.02);
}

TEST(EstimatorOdometry, ASweepOfNumbersThatAreNoneIsNoMotion) {
  Journey journey(moving({0.5, 0, 0}));
  for (int i = 0; i < 10; ++i) journey.sweep();
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  std::vector<LidarPoint> bad(200, {nan, 1, 1, 1, 0});
  for (std::size_t i = 0; i < bad.size(); i += 2) bad[i] = {1, -inf, 1, 1, 0};
  EXPECT_EQ(journey.sweep_of(bad).rejection, SweepRejection::too_few_points);
  EXPECT_TRUE(journey.sweep().tracked);
}

TEST(EstimatorOdometry, BadNumbersAmongGoodOnesChangeNothing) {
  Journey clean(moving({0.5, 0, 0})), dirty(moving({0.5, 0, 0}));
  for (int i = 0; i < 5; ++i) {
    const SweepOutcome wanted = clean.sweep();
    dirty.sweeps.next(dirty.truth, dirty.begin_ns);
    auto points = dirty.sweeps.points();
    points.insert(points.begin() + 100, 10, {std::numeric_limits<float>::quiet_NaN(), 0, 2, 1, 0});
    points.erase(points.end() - 10, points.end());
    auto fewer = clean.sweeps.points();
    const SweepOutcome& outcome = dirty.sweep_of(points);
    EXPECT_TRUE(outcome.T_world_body.p.allFinite());
    EXPECT_LT((outcome.T_world_body.p - wanted.T_world_body.p).norm(), 5e-3) << i;
  }
}

TEST(EstimatorOdometry, AFirstSweepOfBadNumbersDoesNotSpoilTheNext) {
  Journey journey(State{});
  const std::vector<LidarPoint> bad(200, {std::numeric_limits<float>::quiet_NaN(), 1, 1, 1, 0});
  EXPECT_EQ(journey.sweep_of(bad).rejection, SweepRejection::too_few_points);
  EXPECT_TRUE(journey.odometry->map().empty());
  for (int i = 0; i < 10; ++i) journey.sweep();
  EXPECT_TRUE(journey.sweep().tracked);
  EXPECT_LT(journey.odometry->state().p.norm(), 0.05);
}

TEST(EstimatorOdometry, ASinglePlaneIsReportedAsThreeDirectionsNotHeld) {
  Journey journey(State{}, test::floor_only());
  SweepOutcome first, last;
  for (int i = 0; i < 5; ++i) first = journey.sweep();
  for (int i = 0; i < 15; ++i) last = journey.sweep();
  EXPECT_TRUE(last.tracked);
  EXPECT_EQ(last.degenerate_directions, 3);
  // Along the plane the doubt grows from sweep to sweep, across it does not.
  EXPECT_GT(last.covariance(3, 3), 2 * first.covariance(3, 3));
  EXPECT_GT(last.covariance(4, 4), 2 * first.covariance(4, 4));
  EXPECT_LT(last.covariance(5, 5), 2e-4 * last.covariance(3, 3));
}

TEST(EstimatorOdometry, TimeThatRunsBackwardsOrStandsStillIsRejected) {
  Journey journey(State{});
  journey.sweep();
  journey.begin_ns -= kPeriod_ns;
  EXPECT_EQ(journey.sweep().rejection, SweepRejection::time_backwards);
  journey.begin_ns -= 5 * kPeriod_ns;
  EXPECT_EQ(journey.sweep().rejection, SweepRejection::time_backwards);
  journey.begin_ns += 6 * kPeriod_ns;
  EXPECT_TRUE(journey.sweep().tracked);
}

TEST(EstimatorOdometry, TheSameSweepsGiveTheSameBits) {
  Journey a(moving({0.5, 0.2, 0}, {0, 0, 0.5})), b(moving({0.5, 0.2, 0}, {0, 0, 0.5}));
  for (int i = 0; i < 10; ++i) {
    const SweepOutcome& one = a.sweep();
    const SweepOutcome& other = b.sweep();
    ASSERT_EQ(one.T_world_body.p, other.T_world_body.p);
    ASSERT_EQ(one.T_world_body.R, other.T_world_body.R);
    ASSERT_EQ(one.covariance, other.covariance);
  }
}

TEST(EstimatorOdometry, ThePoseIsPublishedAtTheStamp) {
  // Given sweeps named by the middle of their time ...
  Journey journey(moving({1.0, 0, 0}));
  const SweepOutcome* outcome = nullptr;
  for (int i = 0; i < 10; ++i) {
    Sweep sweep = journey.sweeps.next(journey.truth, journey.begin_ns);
    sweep.stamp = sweep.begin + kSweepSpan / 2;
    outcome = &journey.odometry->step(sweep);
    journey.pass(kPeriod_ns);
  }
  // ... then the pose is half a sweep before the state, which is that of the end.
  EXPECT_NEAR((journey.odometry->state().p - outcome->T_world_body.p).x(), 0.05, 0.005);
}

// The normals' error that is no number spoils every update's sums, and nothing else.
TEST(EstimatorOdometry, UpdatesWithoutAFiniteSolutionAreCountedAndThePredictionKept) {
  OdometrySetup setup = test::small_setup();
  setup.estimator.normal_sigma_rad = std::numeric_limits<double>::quiet_NaN();
  Journey journey(State{}, {}, setup);
  journey.sweep();
  SweepOutcome outcome;
  for (int i = 0; i < 5; ++i) {
    outcome = journey.sweep();
    EXPECT_FALSE(outcome.tracked);
    EXPECT_EQ(outcome.T_world_body.p, Vector3d::Zero());
    EXPECT_TRUE(outcome.covariance.allFinite());
  }
  EXPECT_EQ(outcome.not_finite_updates, 5U);  // no second sweep found its motion: each began anew
}

}  // namespace
}  // namespace lxd::estimator_odometry_test
