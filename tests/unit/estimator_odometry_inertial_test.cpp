// SPDX-License-Identifier: Apache-2.0
// The odometry with an IMU and wheels in a simulated room: at rest, on a walk with quick turns, and with an IMU that
// falls silent, hangs, speaks nonsense or begins late.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "tests/support/inertial_journey.hpp"

namespace lxd::estimator_odometry_inertial_test {
namespace {

using Eigen::Vector3d;
using test::inertial_setup;
using test::InertialJourney;

// The largest errors and steps of a journey.
struct Worst {
  double shift_m = 0, turn_rad = 0;
  double step_m = 0, step_rad = 0;  // of one sweep's motion, off the truth's
  int untracked = 0;
  int by[3] = {0, 0, 0};  // sweeps by their source
};

// Sweeps until `until_s`, the first two of which only begin.
Worst watched(InertialJourney& journey, double until_s) {
  Worst worst;
  Pose before, truth_before;
  for (int i = 0; journey.begin_s + 0.1 < until_s + 1e-6; ++i) {
    const SweepOutcome& outcome = journey.sweep();
    const Pose truth = journey.truth();
    if (i > 1) {
      const Pose step = before.inverse() * outcome.T_world_body, wanted = truth_before.inverse() * truth;
      worst.step_m = std::max(worst.step_m, (step.p - wanted.p).norm());
      worst.step_rad = std::max(worst.step_rad, Log(step.R.transpose() * wanted.R).norm());
      worst.shift_m = std::max(worst.shift_m, journey.shift_error_m());
      worst.turn_rad = std::max(worst.turn_rad, journey.turn_error_rad());
      worst.untracked += !outcome.tracked;
      ++worst.by[static_cast<int>(outcome.source)];
    }
    before = outcome.T_world_body;
    truth_before = truth;
  }
  return worst;
}

int by(const Worst& worst, MotionSource source) { return worst.by[static_cast<int>(source)]; }

TEST(EstimatorOdometryInertial, AtRestItStaysAndKnowsIt) {
  InertialJourney journey(test::resting(test::turned(0.4, 0.1, -0.2)), inertial_setup());
  const Worst worst = watched(journey, 4);
  EXPECT_LT(worst.shift_m, 0.01);
  EXPECT_LT(worst.turn_rad, 0.003);
  EXPECT_EQ(by(worst, MotionSource::constant_velocity), 0);
  EXPECT_LT(journey.odometry->state().v.norm(), 0.02);
  EXPECT_LT((journey.odometry->state().b_g - test::kJourneyGyroBias).norm(), 0.002);
  EXPECT_GT(journey.odometry->motion().rests(), 20U);
  // Level: gravity is down in the world that began with a tilted body.
  const Vector3d up = journey.odometry->state().R.transpose() * Vector3d::UnitZ();
  EXPECT_LT((up - journey.way.pose(0).R.transpose() * Vector3d::UnitZ()).norm(), 0.015);
}

TEST(EstimatorOdometryInertial, AWalkWithQuickTurnsIsFollowed) {
  InertialJourney journey(test::walking_about(), inertial_setup());
  const Worst worst = watched(journey, 6);
  RecordProperty("shift_m", std::to_string(worst.shift_m));
  RecordProperty("turn_rad", std::to_string(worst.turn_rad));
  EXPECT_LT(worst.shift_m, 0.01);
  EXPECT_LT(worst.turn_rad, 0.005);
  EXPECT_EQ(worst.untracked, 0);
  EXPECT_EQ(by(worst, MotionSource::constant_velocity), 0);
  EXPECT_LT((journey.odometry->state().b_g - test::kJourneyGyroBias).norm(), 0.01);
}

// The same walk without the IMU is harder: what it is worth is that errors are no larger.
TEST(EstimatorOdometryInertial, TheImuMakesTheWalkNoWorse) {
  InertialJourney with(test::walking_about(), inertial_setup()), without(test::walking_about(), inertial_setup(false));
  const Worst inertial = watched(with, 4.5), blind = watched(without, 4.5);
  EXPECT_EQ(by(blind, MotionSource::imu), 0);
  EXPECT_LT(inertial.shift_m, blind.shift_m + 0.005);
  EXPECT_LT(inertial.turn_rad, blind.turn_rad + 0.002);
}

TEST(EstimatorOdometryInertial, AnImuThatIsLostForAWhileAndReturnsLeavesThePathWhole) {
  for (const double gap_s : {0.1, 1.0, 5.0}) {
    InertialJourney journey(test::walking_about(), inertial_setup());
    journey.fault = [&](double t_s, InertialReading&) { return t_s < 3.013 || t_s > 3.013 + gap_s; };
    const Worst worst = watched(journey, 4 + gap_s);
    EXPECT_LT(worst.shift_m, 0.02) << gap_s;
    EXPECT_LT(worst.turn_rad, 0.01) << gap_s;
    EXPECT_LT(worst.step_m, 0.02) << gap_s;
    EXPECT_LT(worst.step_rad, 0.01) << gap_s;
    EXPECT_EQ(worst.untracked, 0) << gap_s;
    EXPECT_NEAR(by(worst, MotionSource::constant_velocity), 10 * gap_s + 0.5, 1.5) << gap_s;
    EXPECT_EQ(journey.odometry->motion().source(), MotionSource::imu) << gap_s;
  }
}

TEST(EstimatorOdometryInertial, AnImuThatHangsIsFoundOutAndTheLidarGoesOn) {
  InertialJourney journey(test::walking_about(), inertial_setup());
  InertialReading last;
  journey.fault = [&](double t_s, InertialReading& reading) {
    if (t_s > 3 && t_s < 4.5) {
      reading.rate_radps = last.rate_radps;
      reading.force_mps2 = last.force_mps2;
    }
    last = reading;
    return true;
  };
  const Worst worst = watched(journey, 6);
  EXPECT_GT(journey.odometry->motion().inertial_counts().stuck, 250U);
  EXPECT_GT(by(worst, MotionSource::constant_velocity), 12);
  EXPECT_LT(worst.shift_m, 0.02);
  EXPECT_LT(worst.turn_rad, 0.025);
  EXPECT_EQ(journey.odometry->motion().source(), MotionSource::imu);
}

TEST(EstimatorOdometryInertial, ReadingsThatAreNoNumbersAreAsGoodAsNone) {
  InertialJourney journey(test::walking_about(), inertial_setup()), few(test::walking_about(), inertial_setup());
  journey.fault = [](double t_s, InertialReading& reading) {
    if (t_s > 3 && t_s < 4) reading.rate_radps.y() = std::numeric_limits<double>::quiet_NaN();
    if (t_s > 4 && t_s < 4.5) reading.force_mps2.x() = std::numeric_limits<double>::infinity();
    return true;
  };
  few.fault = [](double t_s, InertialReading&) { return t_s < 3 || t_s > 4.5; };
  const Worst bad = watched(journey, 5), none = watched(few, 5);
  EXPECT_GT(journey.odometry->motion().inertial_counts().not_finite, 290U);
  EXPECT_LT(bad.shift_m, 0.04);
  EXPECT_NEAR(bad.shift_m, none.shift_m, 0.005);
  EXPECT_TRUE(journey.odometry->state().p.allFinite());
}

// Nothing aligned the IMU when the world began: it is aligned with the LiDAR's motion when it is heard.
TEST(EstimatorOdometryInertial, AnImuThatBeginsLateIsAlignedAndUsed) {
  InertialJourney journey(test::walking_about(), inertial_setup());
  journey.fault = [](double t_s, InertialReading&) { return t_s > 2; };
  const Worst worst = watched(journey, 6);
  EXPECT_GT(by(worst, MotionSource::constant_velocity), 5);
  EXPECT_GT(by(worst, MotionSource::imu), 30);
  EXPECT_LT(worst.shift_m, 0.02);
  EXPECT_LT(worst.turn_rad, 0.01);
  EXPECT_EQ(worst.untracked, 0);
}

TEST(EstimatorOdometryInertial, WheelsCarryARobotWithAnImuAndWithoutOne) {
  for (const bool imu : {false, true}) {
    InertialJourney journey(test::driving_about(), inertial_setup(imu, true));
    const Worst worst = watched(journey, 4);
    EXPECT_EQ(by(worst, imu ? MotionSource::imu : MotionSource::wheel), 31) << imu;
    EXPECT_LT(worst.shift_m, 0.02) << imu;
    EXPECT_LT(worst.turn_rad, 0.006) << imu;
    EXPECT_LT((journey.odometry->state().v.norm() - 1), 0.05) << imu;
    EXPECT_EQ(journey.odometry->motion().slipping(), 0U) << imu;
  }
}

TEST(EstimatorOdometryInertial, TheSameReadingsGiveTheSameBits) {
  InertialJourney a(test::walking_about(), inertial_setup(true, false)),
      b(test::walking_about(), inertial_setup(true, false));
  for (int i = 0; i < 15; ++i) {
    const SweepOutcome& one = a.sweep();
    const SweepOutcome& other = b.sweep();
    ASSERT_EQ(one.T_world_body.p, other.T_world_body.p);
    ASSERT_EQ(one.T_world_body.R, other.T_world_body.R);
    ASSERT_EQ(one.covariance, other.covariance);
  }
}

}  // namespace
}  // namespace lxd::estimator_odometry_inertial_test
