// SPDX-License-Identifier: Apache-2.0
// What carries the state, chosen anew for every sweep: how the IMU begins, how it is set aside when it falls silent and
// taken up again, what wheels add, and when the body is said to be at rest.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/carried_body.hpp"
#include "tests/support/estimator_states.hpp"

namespace lxd::estimator_motion_test {
namespace {

using Eigen::Vector3d;
using test::InertialMotion;
using test::StateChance;

using test::aligned;
using test::at;
using test::Carried;
using test::kBegin_s;
using test::kImuNoise;
using test::kSweep_s;
using test::kTrueBias;
using test::with_imu;
using test::with_wheel;

TEST(EstimatorMotion, BeginsLevelFromARestingImuHoweverItLies) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    StateChance chance(seed);
    const Eigen::Matrix3d R = Exp(chance.vector(2));
    Carried body(with_imu(), test::resting(R));
    body.read(0.8, 1.0);
    const Motion::Beginning known = body.motion.begin(at(0.8), at(1.0));
    // Up is where it is; about it nothing is known.
    EXPECT_LT((known.x.R.transpose() * Vector3d::UnitZ() - R.transpose() * Vector3d::UnitZ()).norm(), 2e-3) << seed;
    EXPECT_LT((known.x.b_g + kTrueBias).norm(), 1e-3) << seed;
    EXPECT_LT(known.P(kGyroBias, kGyroBias), 1e-3);
    EXPECT_GT(known.P(kVelocity, kVelocity), 1);
    EXPECT_EQ((known.P.topLeftCorner<6, 6>().norm()), 0);
  }
}

TEST(EstimatorMotion, WithoutReadingsItBeginsAsAnyCarrierMay) {
  Carried body(with_imu(), test::resting());
  const Motion::Beginning nothing = body.motion.begin(at(0.8), at(1.0));
  EXPECT_EQ(nothing.x.R, Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
  EXPECT_GE(nothing.P(kGyroBias, kGyroBias), 1);
  body.align();
  body.read(1.0, 2.0);
  EXPECT_EQ(body.sweep(), MotionSource::constant_velocity);  // not aligned
}

TEST(EstimatorMotion, ReadingsInFreeFallTellNoVertical) {
  Carried body(with_imu(), test::resting());
  for (int i = 0; i < 20; ++i)
    body.motion.add(InertialReading{at(0.8 + 0.01 * i), {0.1 + 1e-6 * i, 0, 0}, {0.1, 0, 0}});
  EXPECT_EQ(body.motion.begin(at(0.8), at(1.0)).x.R, Eigen::Matrix3d(Eigen::Matrix3d::Identity()));
}

TEST(EstimatorMotion, AlignedAtRestTheBiasIsFoundAndGravityKnownToItsPlace) {
  Carried body = aligned(test::resting(), 1.2);
  ASSERT_EQ(body.sweep(), MotionSource::imu);
  const Calibration c = body.filter.calibration();
  EXPECT_LT((c.b_g - kTrueBias).norm(), 1e-3);
  EXPECT_NEAR(c.g.z(), -9.80665, 0.02);
  EXPECT_LT(std::sqrt(c.P(6, 6)), 0.15);   // across
  EXPECT_LT(std::sqrt(c.P(8, 8)), 0.025);  // along
  EXPECT_GT(std::sqrt(c.P(8, 8)), 0.015);
  EXPECT_LT(body.shift_m(), 1e-3);
}

// What levelled the world had the carrier's acceleration in it: gravity is doubted across by as much. A steady one
// below 1 m/s^2 does not show in the force's length and is not seen: a known limit.
TEST(EstimatorMotion, AlignedWhileAcceleratingGravityIsDoubted) {
  for (const double a : {1.5, 3.0}) {
    Carried body = aligned(InertialMotion([a](double t) {
                             return Pose{Eigen::Matrix3d::Identity(), {a * t * t / 2, 0, 0}};
                           }),
                           1.2);
    ASSERT_EQ(body.sweep(), MotionSource::imu);
    const Calibration c = body.filter.calibration();
    // Seen from the level that was believed, gravity is off by its tilt, atan(a / g).
    const double across = 9.80665 * std::atan(a / 9.80665);
    EXPECT_GT(std::sqrt(c.P(6, 6)), across / 2.5) << a;
    EXPECT_LT(std::sqrt(c.P(6, 6)), 1.5 * a + 0.2) << a;
    EXPECT_GT(std::sqrt(c.P(8, 8)), 0.02 + 0.4 * across * across / 2.5 / 2.5 / (2 * 9.80665)) << a;
  }
  // Shaken: the mean is that of rest, the scatter is not.
  Carried shaken = aligned(InertialMotion([](double t) {
                             return Pose{Eigen::Matrix3d::Identity(), {0.01 * std::sin(20 * t), 0, 0}};
                           }),
                           1.2);
  ASSERT_EQ(shaken.sweep(), MotionSource::imu);
  EXPECT_GT(std::sqrt(shaken.filter.calibration().P(6, 6)), 1);
}

TEST(EstimatorMotion, TheImuFollowsWhatConstantVelocityCannot) {
  const auto way = test::walking_about();
  Carried body = aligned(way, 3.2), blind({{}, std::nullopt, std::nullopt}, way);
  for (int i = 0; i < 20; ++i) {
    ASSERT_EQ(body.sweep(), MotionSource::imu);
    EXPECT_EQ(blind.sweep(), MotionSource::constant_velocity);
  }
  EXPECT_LT(body.shift_m(), 0.1);  // gravity has what the carrier accelerated by while it was aligned
  EXPECT_LT(body.turn_rad(), 0.01);
  EXPECT_GT(blind.shift_m(), 0.3);
}

TEST(EstimatorMotion, SilenceOfTheImuLeavesConstantVelocityWithTheLastRate) {
  // The readings end so long before or after the last sweep that they cover does.
  for (const double early_s : {-0.005, 0.005, 0.015, 0.025}) {
    Carried body = aligned(test::steady({1, 0, 0}, 2.0), 2.0 - early_s);
    for (int i = 0; i < 10; ++i) ASSERT_EQ(body.sweep(), MotionSource::imu) << early_s;
    const StateMatrix before = body.filter.covariance();
    ASSERT_EQ(body.sweep(), MotionSource::constant_velocity) << early_s;
    EXPECT_NEAR(-body.filter.state().b_g.z(), 2.0, 0.03) << early_s;
    EXPECT_LT(body.shift_m(), 0.03) << early_s;
    EXPECT_LT(body.turn_rad(), 0.02) << early_s;
    // Biases and gravity wait; the rate is doubted.
    EXPECT_EQ((body.filter.covariance().bottomRows<6>().norm()), 0) << early_s;
    EXPECT_GT(body.filter.covariance()(kGyroBias, kGyroBias), before(kGyroBias, kGyroBias) + 0.05 * 0.05) << early_s;
  }
}

TEST(EstimatorMotion, WhatReturnsIsTakenUpWithItsBiasesAndAGrownDoubt) {
  for (const double gap_s : {0.1, 1.0, 5.0}) {
    Carried body = aligned(test::steady({0.3, 0, 0}, 0.5), 1.5);
    for (int i = 0; i < 5; ++i) ASSERT_EQ(body.sweep(), MotionSource::imu);
    const Calibration left = body.filter.calibration();
    body.read(1.5 + gap_s, 3.0 + gap_s);
    const int sweeps = static_cast<int>(std::lround(gap_s / kSweep_s));
    for (int i = 0; i < sweeps; ++i) ASSERT_EQ(body.sweep(), MotionSource::constant_velocity) << gap_s;
    // ... continuous, by the last rate and speed ...
    EXPECT_LT(body.shift_m(), 0.01 + 0.03 * gap_s) << gap_s;
    EXPECT_LT(body.turn_rad(), 0.01 + 0.01 * gap_s) << gap_s;
    ASSERT_EQ(body.sweep(), MotionSource::imu) << gap_s;
    const Calibration back = body.filter.calibration();
    EXPECT_LT((back.b_g - left.b_g).norm(), 1e-12) << gap_s;
    EXPECT_LT((back.g - left.g).norm(), 1e-12) << gap_s;
    const double walked = kImuNoise.gyro_walk * kImuNoise.gyro_walk * (gap_s + kSweep_s);
    EXPECT_NEAR(back.P(0, 0) - left.P(0, 0), walked, 0.01 * walked) << gap_s;
    // ... and it turns on from there.
    const double turn = body.turn_rad();
    for (int i = 0; i < 10; ++i) ASSERT_EQ(body.sweep(), MotionSource::imu) << gap_s;
    EXPECT_LT(body.turn_rad(), turn + 0.01) << gap_s;
    EXPECT_TRUE(body.filter.covariance().allFinite());
    EXPECT_GT(test::least_relative_eigenvalue(body.filter.covariance()), -1e-12) << gap_s;
  }
}

TEST(EstimatorMotion, AGapOfTwentyMillisecondsIsBridged) {
  Carried body = aligned(test::steady({0.3, 0, 0}, 1.0), 1.53);
  body.read(1.55, 3.0);
  for (int i = 0; i < 15; ++i) EXPECT_EQ(body.sweep(), MotionSource::imu) << i;
  EXPECT_LT(body.turn_rad(), 0.01);
}

TEST(EstimatorMotion, AnImuThatIsNotInUseIsNotRead) {
  Carried body = aligned(test::steady({0.3, 0, 0}, 1.0), 3.0, with_wheel());
  EXPECT_EQ(body.sweep(), MotionSource::constant_velocity);
  EXPECT_LT(body.motion.inertial_until(), at(0));
}

TEST(EstimatorMotion, RestartForgetsTheAlignmentAndNotTheReadings) {
  Carried body = aligned(test::resting(), 3.0);
  ASSERT_EQ(body.sweep(), MotionSource::imu);
  body.motion.restart();
  EXPECT_EQ(body.sweep(), MotionSource::constant_velocity);
  body.align();
  EXPECT_EQ(body.sweep(), MotionSource::imu);
}

TEST(EstimatorMotion, TheSweepsPathIsAlongTheReadings) {
  const auto way = test::walking_about();
  Carried body = aligned(way, 4.0);
  for (int i = 0; i < 20; ++i) ASSERT_EQ(body.sweep(), MotionSource::imu);
  State end = way.state(body.now_s);
  end.b_g = kTrueBias;
  for (const double before_s : {0.0, 0.03, 0.07, 0.1}) {
    const PathKnot pose = body.motion.knot(end, at(body.now_s - before_s), at(body.now_s));
    const Pose truth = way.pose(body.now_s - before_s);
    EXPECT_LT((pose.p - truth.p).norm(), 1e-3) << before_s;
    EXPECT_LT(Log(pose.R.transpose() * truth.R).norm(), 2e-3) << before_s;
  }
}

// Constant velocity knows a tenth of a second later to centimetres and milliradians only where the body was; along
// readings the path is known to what the gyroscope and the accelerometer scatter by.
TEST(EstimatorMotion, ThePathIsDoubtedByWhatNothingMeasured) {
  Carried guided = aligned(test::resting(), 2.0), blind({{}, std::nullopt, std::nullopt}, test::resting());
  ASSERT_EQ(guided.sweep(), MotionSource::imu);
  ASSERT_EQ(blind.sweep(), MotionSource::constant_velocity);
  const EstimatorConfig config;
  const auto before = [](const Carried& body, double before_s) -> Vector6d {
    return body.motion.path_variance(at(body.now_s - before_s), at(body.now_s));
  };
  EXPECT_EQ(before(blind, 0).norm(), 0);
  for (const double span_s : {0.05, 0.1}) {
    const Vector6d unknown = before(blind, span_s), known = before(guided, span_s);
    EXPECT_NEAR(std::sqrt(unknown[0]), config.angular_acceleration_density * std::sqrt(span_s * span_s * span_s / 3),
                1e-9);
    EXPECT_NEAR(std::sqrt(unknown[3]), config.acceleration_density * std::sqrt(span_s * span_s * span_s / 3), 1e-9);
    EXPECT_NEAR(std::sqrt(known[0]), kImuNoise.gyro_density * std::sqrt(span_s), 1e-9);
    EXPECT_NEAR(std::sqrt(known[3] / unknown[3]), kImuNoise.accel_density / config.acceleration_density, 1e-9);
  }
}

}  // namespace
}  // namespace lxd::estimator_motion_test
