// SPDX-License-Identifier: Apache-2.0
// The IMU's clock against the LiDAR's: how the state errs by it, and that it is found out.
#include <cmath>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "estimator/ieskf.hpp"
#include "estimator/imu_delay.hpp"
#include "estimator/rate_information.hpp"
#include "tests/support/inertial_journey.hpp"
#include "tests/support/mapping_scene.hpp"

namespace lxd::estimator_imu_delay_test {
namespace {

using Eigen::Vector3d;
using test::inertial_setup;
using test::InertialJourney;

constexpr double kMost_s = 0.05;  // that is believed

OdometrySetup unsure(double delay_s, double sigma_s) {
  OdometrySetup setup = inertial_setup();
  setup.imu->delay_s = delay_s;
  setup.imu->delay_sigma_s = sigma_s;
  return setup;
}

// A walk of `sweeps` whose readings are stamped so much too late.
void walk(InertialJourney& journey, double late_s, int sweeps) {
  journey.fault = [late_s](double, InertialReading& reading) {
    reading.t = reading.t + Duration::from_seconds(late_s);
    return true;
  };
  for (int i = 0; i < sweeps; ++i) journey.sweep();
}

// Given readings of a walk that are heard in time, and the same ones heard late, when a state is carried on by either
// over a sweep, then the two differ by the delay times what the filter says of it.
TEST(ImuDelay, TheStateErrsByItAsItSays) {
  constexpr double kLate_s = 2e-4, kPeriod_s = 0.0025;
  const test::InertialMotion way = test::walking_about();
  test::OwnedArena arena(std::size_t{1} << 22);
  ImuHistory in_time(*arena), late(*arena);
  for (double t_s = 3; t_s < 4; t_s += kPeriod_s) {
    InertialReading reading = way.reading(t_s);
    in_time.add(reading);
    reading.t = reading.t + Duration::from_seconds(kLate_s);
    late.add(reading);
  }
  State x = way.state(3.5);
  x.b_g.setZero();
  Ieskf right(ImuDelay(0, 0.01)), wrong(ImuDelay(0, 0.01));
  for (Ieskf* filter : {&right, &wrong}) filter->reset(x, StateMatrix::Identity());
  const RigTime from = RigTime::from_seconds(3.5), to = RigTime::from_seconds(3.6);
  for (const InertialSpan& span : in_time.spans(from, to)) right.predict(span, test::kJourneyNoise);
  for (const InertialSpan& span : late.spans(from, to)) wrong.predict(span, test::kJourneyNoise);
  const StateVector found = boxminus(right.state(), wrong.state()) / kLate_s, said = wrong.delay().state_by_delay();
  EXPECT_GT(said.head<3>().norm(), 0.05);  // rad/s: the walk turns
  EXPECT_LT((found - said).head<3>().norm(), 0.02 * said.head<3>().norm());
  EXPECT_LT((found - said).segment<3>(kVelocity).norm(), 0.03 * said.segment<3>(kVelocity).norm());
  EXPECT_LT((found - said).segment<3>(kPosition).norm(), 0.03 * said.segment<3>(kPosition).norm());
}

// The body's turn between an instant and the sweep's end, by readings that are taken for a little later than they are.
TEST(ImuDelay, TheSkewErrsByItAsItSays) {
  constexpr double kStep_s = 1e-4;
  const test::InertialMotion way = test::walking_about();
  test::OwnedArena arena(std::size_t{1} << 22);
  ImuHistory history(*arena);
  for (double t_s = 3; t_s < 4; t_s += 0.0025) history.add(way.reading(t_s));
  State end = way.state(3.6);
  end.b_g = Vector3d(0.01, -0.02, 0.03);
  const Vector3d q(4, -3, 1), n = Vector3d(0.2, 0.9, -0.4).normalized();
  const auto knot_with = [&](double delay_s, double before_end_s) {
    history.set_delay(Duration::from_seconds(delay_s));
    return SweepPath::knot(end, before_end_s, history.spans(RigTime::from_seconds(3.45), RigTime::from_seconds(3.6)));
  };
  for (const double before_end_s : {0.0, 0.021, 0.05, 0.1}) {
    const PathKnot knot = knot_with(0, before_end_s), later = knot_with(kStep_s, before_end_s);
    const Vector3d turn = Log(later.turn * knot.turn.transpose()) / kStep_s;
    EXPECT_LT((turn - knot.turn_by_delay).norm(), 0.01 + 0.02 * knot.turn_by_delay.norm()) << before_end_s;
    const double along = n.dot((later.R - knot.R) * q) / kStep_s;
    EXPECT_NEAR(row_by_delay(knot, q, n), along, 0.02 + 0.02 * std::abs(along)) << before_end_s;
  }
  EXPECT_GT(knot_with(0, 0.1).turn_by_delay.norm(), 0.1);  // rad/s: the walk turns
}

// A problem of a state and a delay that is linear throughout.
struct Linear {
  static constexpr int kRows = 40;
  explicit Linear(std::uint32_t seed) : chance(seed) {
    P.topLeftCorner<kLidarDim, kLidarDim>() = chance.covariance<kLidarDim>(0.3);
    for (int i = 0; i < kRows; ++i) {
      for (int j = 0; j < kLidarDim; ++j) H(i, j) = chance.normal();
      c[i] = chance.normal();
      r[i] = 0.02 * chance.normal();
    }
  }
  test::StateChance chance;
  StateMatrix P = 1e-3 * StateMatrix::Identity();
  Eigen::Matrix<double, kRows, kLidarDim> H;
  Eigen::Matrix<double, kRows, 1> c, r;
};

// Given a state that errs with the delay, and rows that show both, when the delay is told from the state's update, then
// it is what a filter says that has the delay for one state more.
TEST(ImuDelay, IsWhatOneStateMoreWouldSay) {
  constexpr double kSigma_s = 0.7;
  Linear problem(7);
  ImuDelay delay(0, kSigma_s);
  StateMatrix F = StateMatrix::Identity();
  F.block<12, 6>(0, kGyroBias) = Eigen::Matrix<double, 12, 6>::NullaryExpr([&]() { return problem.chance.normal(); });
  delay.predict(
      F, {1e-9, Vector3d::Zero(), Vector3d::Zero(), 1e-9 * problem.chance.vector(1), 1e-9 * problem.chance.vector(1)});
  const StateVector V = delay.state_by_delay();
  ASSERT_GT(V.head<6>().norm(), 0.5);

  // One state more.
  Eigen::Matrix<double, kStateDim + 1, kStateDim + 1> joint;
  joint.topLeftCorner<kStateDim, kStateDim>() = problem.P + kSigma_s * kSigma_s * V * V.transpose();
  joint.topRightCorner<kStateDim, 1>() = kSigma_s * kSigma_s * V;
  joint.bottomLeftCorner<1, kStateDim>() = kSigma_s * kSigma_s * V.transpose();
  joint(kStateDim, kStateDim) = kSigma_s * kSigma_s;
  Eigen::Matrix<double, Linear::kRows, kStateDim + 1> rows =
      Eigen::Matrix<double, Linear::kRows, kStateDim + 1>::Zero();
  rows.leftCols<kLidarDim>() = problem.H;
  rows.col(kStateDim) = problem.c;
  const Eigen::Matrix<double, kStateDim + 1, kStateDim + 1> after =
      (joint.inverse() + rows.transpose() * rows).inverse();
  const Eigen::Matrix<double, kStateDim + 1, 1> wanted = -after * rows.transpose() * problem.r;

  // The state alone, and the delay from it.
  const StateMatrix L = problem.P.inverse();
  const LidarMatrix A = problem.H.transpose() * problem.H;
  StateMatrix information = L;
  information.topLeftCorner<kLidarDim, kLidarDim>() += A;
  const StateMatrix posterior = information.inverse();
  const StateVector dx = -posterior.leftCols<kLidarDim>() * (problem.H.transpose() * problem.r);
  const Eigen::Matrix<double, Linear::kRows, 1> left = problem.r + problem.H * dx.head<kLidarDim>();
  const DelaySums skew{problem.H.transpose() * problem.c, problem.c.squaredNorm(), problem.c.dot(left)};
  delay.update({L, A, posterior, dx, 1.0, skew});

  ASSERT_LT(std::abs(wanted[kStateDim]), kMost_s);
  EXPECT_NEAR(delay.delay_s(), wanted[kStateDim], 1e-9);
  EXPECT_NEAR(delay.sigma_s(), std::sqrt(after(kStateDim, kStateDim)), 1e-9);
  const StateVector shared = after.topRightCorner<kStateDim, 1>() / after(kStateDim, kStateDim);
  EXPECT_LT((delay.state_by_delay() - shared).norm(), 1e-8 * (1 + shared.norm()));
}

// However little of the skew is believed, what is left is the information of something: no direction's is negative.
TEST(ImuDelay, DoubtInTheSkewLeavesItsInformationSound) {
  Linear problem(11);
  const LidarMatrix A = problem.H.transpose() * problem.H;
  DelaySums sums{problem.H.transpose() * problem.c, problem.c.squaredNorm(), 0};
  const DelaySums before = sums;
  limit(Linear::kRows, A, Eigen::Matrix<double, 6, 1>::Zero(), sums);  // too few rows to be doubted
  EXPECT_EQ(sums.information, before.information);
  NormalEquations limited;
  limited.information = A;
  limit_rates(4000, limited);
  limit(4000, limited.information, Eigen::Matrix<double, 6, 1>::Zero(), sums);
  EXPECT_LT(sums.information, before.information);
  Eigen::Matrix<double, kLidarDim + 1, kLidarDim + 1> all;
  all << limited.information, sums.coupling, sums.coupling.transpose(), sums.information;
  EXPECT_GT(all.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(), -1e-9);
}

TEST(ImuDelay, AnImuThatIsHeardLateIsFoundOutAndCostsNothing) {
  for (const double late_s : {-0.008, 0.003, 0.02}) {
    InertialJourney journey(test::walking_about(), unsure(0, 0.01)), in_time(test::walking_about(), inertial_setup());
    walk(journey, late_s, 60);
    walk(in_time, 0, 60);
    const ImuDelay& found = journey.odometry->imu_delay();
    EXPECT_NEAR(found.delay_s(), late_s, 5e-4) << late_s;
    EXPECT_LT(std::abs(found.delay_s() - late_s), 4 * found.sigma_s()) << late_s;
    EXPECT_LT(found.sigma_s(), 5e-4) << late_s;
    EXPECT_LT(journey.shift_error_m(), in_time.shift_error_m() + 0.003) << late_s;
    EXPECT_LT(journey.turn_error_rad(), in_time.turn_error_rad() + 0.002) << late_s;
  }
}

TEST(ImuDelay, WhatTheRigFileSaysExactlyIsBelieved) {
  InertialJourney right(test::walking_about(), unsure(0.008, 0)), wrong(test::walking_about(), unsure(0, 0));
  walk(right, 0.008, 60);
  walk(wrong, 0.008, 60);
  EXPECT_EQ(right.odometry->imu_delay().delay_s(), 0.008);
  EXPECT_EQ(wrong.odometry->imu_delay().delay_s(), 0);
  EXPECT_EQ(right.odometry->imu_delay().sigma_s(), 0);
  EXPECT_LT(right.odometry->outcome().innovation.per_dimension(), 3);
}

// Without a turn nothing tells when it was.
TEST(ImuDelay, AtRestNothingIsLearnt) {
  InertialJourney journey(test::resting(), unsure(0, 0.002));
  walk(journey, 0.008, 40);
  const ImuDelay& found = journey.odometry->imu_delay();
  EXPECT_GT(found.sigma_s(), 0.0015);
  EXPECT_LT(std::abs(found.delay_s()), 0.002);
}

TEST(ImuDelay, FartherApartThanARigCanBeIsNotBelieved) {
  for (const double late_s : {0.047, 0.07}) {
    InertialJourney journey(test::walking_about(), unsure(0.04, 0.01));
    walk(journey, late_s, 60);
    const double found_s = journey.odometry->imu_delay().delay_s();
    EXPECT_LE(found_s, kMost_s) << late_s;
    EXPECT_NEAR(found_s, std::min(late_s, kMost_s), 2e-3) << late_s;
  }
}

// A reading that is heard late is of the instant before.
TEST(ImuDelay, HistoryIsAskedByInstantsNotByStamps) {
  const test::InertialMotion way = test::walking_about();
  test::OwnedArena arena(std::size_t{1} << 22);
  ImuHistory history(*arena);
  for (int i = 0; i < 200; ++i) {
    InertialReading reading = way.reading(3 + 0.005 * i);
    reading.t = reading.t + Duration::from_seconds(0.02);
    history.add(reading);
  }
  history.set_delay(Duration::from_seconds(0.02));
  EXPECT_TRUE(history.covers(RigTime::from_seconds(3.0), RigTime::from_seconds(3.9), Duration::from_seconds(0.03)));
  EXPECT_LT((history.value_at(RigTime::from_seconds(3.4025)).rate_radps - way.rate(3.4025)).norm(), 1e-3);
  double sum_s = 0;
  for (const InertialSpan& span : history.spans(RigTime::from_seconds(3.401), RigTime::from_seconds(3.459)))
    sum_s += span.span_s;
  EXPECT_NEAR(sum_s, 0.058, 1e-9);
  EXPECT_LT((history.mean(RigTime::from_seconds(3.4), RigTime::from_seconds(3.41)).rate_radps - way.rate(3.405)).norm(),
            1e-2);
}

}  // namespace
}  // namespace lxd::estimator_imu_delay_test
