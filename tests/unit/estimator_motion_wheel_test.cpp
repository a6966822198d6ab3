// SPDX-License-Identifier: Apache-2.0
// Wheels as they come between two sweeps, with an IMU and without one; and rest, to which all sensors must agree.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/carried_body.hpp"

namespace lxd::estimator_motion_wheel_test {
namespace {

using Eigen::Vector3d;
using test::aligned;
using test::at;
using test::Carried;
using test::with_both;
using test::with_imu;
using test::with_wheel;

TEST(EstimatorMotionWheel, WheelsAloneCarryARobotThroughItsTurns) {
  const auto way = test::driving_about();
  Carried body(with_wheel(), way), blind({{}, std::nullopt, std::nullopt}, way);
  body.roll(1.0, 5.0);
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(body.sweep(), MotionSource::wheel);
    blind.sweep();
  }
  // 3 m of way in a circle: told by speed and yaw rate alone.
  EXPECT_LT(body.shift_m(), 0.1);
  EXPECT_LT(body.turn_rad(), 0.05);
  EXPECT_GT(blind.shift_m(), 0.5);
  EXPECT_EQ(body.motion.slipping(), 0U);
}

TEST(EstimatorMotionWheel, WithAnImuTheSourceIsTheImuAndTheWheelsHoldTheSpeed) {
  const auto way = test::driving_about();
  Carried body = aligned(way, 11, with_both()), alone = aligned(way, 11);
  body.roll(1.0, 11);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(body.sweep(), MotionSource::imu);
    alone.sweep();
  }
  const auto speed_error = [&](Carried& of) { return (of.filter.state().v - way.velocity(of.now_s)).norm(); };
  EXPECT_LT(speed_error(body), 0.03);
  const auto doubt = [](const Carried& of) { return of.filter.covariance().diagonal().segment<3>(kVelocity).sum(); };
  EXPECT_LT(doubt(body), 0.2 * doubt(alone));
  EXPECT_LT(body.shift_m(), 0.3);
}

TEST(EstimatorMotionWheel, WhenTheWheelsFallSilentItIsConstantVelocityAgain) {
  Carried body(with_wheel(), test::steady({1, 0, 0}, 0));
  body.roll(1.0, 1.45);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(body.sweep(), MotionSource::wheel) << i;
  EXPECT_EQ(body.sweep(), MotionSource::constant_velocity);
  EXPECT_LT(body.shift_m(), 0.01);
}

TEST(EstimatorMotionWheel, AWheelThatSpinsIsCountedAndNotBelieved) {
  Carried body(with_wheel(), test::steady({1, 0, 0}, 0));
  body.roll(1.0, 2.0);
  for (int i = 0; i < 10; ++i) body.sweep();
  for (int i = 1; i <= 5; ++i) body.motion.add(WheelReading{at(2.0 + 0.02 * i), 8.0, 0});
  EXPECT_EQ(body.sweep(), MotionSource::constant_velocity);
  EXPECT_EQ(body.motion.slipping(), 5U);
  EXPECT_LT(body.shift_m(), 0.01);
}

TEST(EstimatorMotionWheel, ReadingsThatAreLateOrNoNumbersAreNotTaken) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Carried body(with_wheel(), test::resting());
  body.motion.add(WheelReading{at(1.05), nan, 0});
  body.motion.add(WheelReading{at(1.06), 0, INFINITY});
  EXPECT_EQ(body.sweep(), MotionSource::constant_velocity);
  body.motion.add(WheelReading{at(1.15), 0, 0});
  body.motion.add(WheelReading{at(1.15), 5, 0});
  body.motion.add(WheelReading{at(1.12), 5, 0});
  EXPECT_EQ(body.sweep(), MotionSource::wheel);
  EXPECT_EQ(body.motion.slipping(), 0U);
}

TEST(EstimatorMotionWheel, ReadingsAfterTheSweepWaitForTheNext) {
  Carried body(with_wheel(), test::resting());
  body.motion.add(WheelReading{at(1.15), 0, 0});
  EXPECT_EQ(body.sweep(), MotionSource::constant_velocity);
  EXPECT_EQ(body.sweep(), MotionSource::wheel);
  EXPECT_EQ(body.sweep(), MotionSource::constant_velocity);
}

// Readings of more wheels than the ring holds: the newest are kept.
TEST(EstimatorMotionWheel, ARingThatOverflowsKeepsTheNewest) {
  Carried body(with_wheel(), test::steady({1, 0, 0}, 0));
  for (std::uint32_t i = 0; i < WheelHistory::kReadings + 300; ++i)
    body.motion.add(WheelReading{at(1.0 + 1e-4 * (i + 1)), 1, 0});
  EXPECT_EQ(body.sweep(), MotionSource::wheel);
  body.sweep();
  EXPECT_LT(body.shift_m(), 0.01);
}

TEST(EstimatorMotionWheel, AtRestSpeedAndBiasAreTold) {
  Carried body = aligned(test::resting(), 3.0);
  body.filter.reset(body.way.state(1.0), test::known());
  for (int i = 0; i < 20; ++i) ASSERT_EQ(body.sweep(), MotionSource::imu);
  EXPECT_GT(body.motion.rests(), 15U);
  EXPECT_LT(body.filter.state().v.norm(), 1e-3);
  EXPECT_LT((body.filter.state().b_g - test::kTrueBias).norm(), 5e-4);
  EXPECT_LT(std::sqrt(body.filter.covariance()(kVelocity + 0, kVelocity + 0)), 0.02);
}

TEST(EstimatorMotionWheel, WheelsThatStandAgreeToRestAndWheelsThatRollDoNot) {
  const auto rests = [](double speed_mps) {
    Carried body = aligned(test::resting(), 3.0, with_both());
    for (double t = 1.0; t < 3.0; t += 0.02) body.motion.add(WheelReading{at(t), speed_mps, 0});
    for (int i = 0; i < 20; ++i) body.sweep();
    return body.motion.rests();
  };
  EXPECT_GT(rests(0.0), 15U);
  EXPECT_GT(rests(0.009), 15U);
  EXPECT_EQ(rests(0.011), 0U);
  EXPECT_EQ(rests(-0.5), 0U);
}

// An IMU that feels nothing is at rest or moves steadily: the filter's knowledge tells which.
TEST(EstimatorMotionWheel, AnImuThatFeelsNothingIsNotAtRestWhereTheFilterKnowsASpeed) {
  const auto rests = [](double speed_mps, double sigma_mps) {
    Carried body = aligned(test::steady({speed_mps, 0, 0}, 0), 3.0);
    StateMatrix P = test::known();
    P.diagonal().segment<3>(kVelocity).setConstant(sigma_mps * sigma_mps);
    body.filter.reset(body.way.state(1.0), P);
    body.sweep();
    return body.motion.rests();
  };
  EXPECT_EQ(rests(0.0, 0.01), 1U);
  EXPECT_EQ(rests(0.14, 0.1), 1U);   // less sure than it is fast
  EXPECT_EQ(rests(0.14, 0.01), 0U);  // surer than the gate
  EXPECT_EQ(rests(0.16, 0.1), 0U);   // too fast, whatever the doubt
  EXPECT_EQ(rests(10, 1), 0U);
}

TEST(EstimatorMotionWheel, WhatTurnsOrShakesIsNotAtRest) {
  const auto rests = [](const test::InertialMotion& way) {
    Carried body = aligned(way, 3.0);
    for (int i = 0; i < 20; ++i) body.sweep();
    return body.motion.rests();
  };
  EXPECT_EQ(rests(test::steady({0, 0, 0}, 0.1)), 0U);
  EXPECT_EQ(rests(test::InertialMotion([](double t) {
              return Pose{Eigen::Matrix3d::Identity(), {2e-4 * std::sin(60 * t), 0, 0}};
            })),
            0U);
  EXPECT_EQ(rests(test::walking_about()), 0U);
}

}  // namespace
}  // namespace lxd::estimator_motion_wheel_test
