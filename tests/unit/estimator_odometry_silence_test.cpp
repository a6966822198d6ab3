// SPDX-License-Identifier: Apache-2.0
// The primary LiDAR falls silent on the way: the other sensors carry the pose on as long as they know it, and the first
// sweep that comes again takes it up.
#include <gtest/gtest.h>

#include "tests/support/inertial_journey.hpp"

namespace lxd::estimator_odometry_silence_test {
namespace {

using test::inertial_setup;
using test::InertialJourney;

void see(InertialJourney& journey, int sweeps) {
  for (int i = 0; i < sweeps; ++i) journey.sweep();
}

struct Silence {
  int carried = 0;
  double shift_m = 0, turn_rad = 0;  // the worst
};

Silence fall_silent(InertialJourney& journey, int sweeps) {
  Silence silence;
  journey.lidar_is_silent = true;
  for (int i = 0; i < sweeps; ++i) {
    const SweepOutcome& outcome = journey.sweep();
    if (outcome.rejection != SweepRejection::none) break;
    EXPECT_TRUE(outcome.carried);
    EXPECT_FALSE(outcome.tracked);
    EXPECT_FALSE(outcome.at_work.primary_lidar);
    EXPECT_TRUE(outcome.registered.empty());
    ++silence.carried;
    silence.shift_m = std::max(silence.shift_m, journey.shift_error_m());
    silence.turn_rad = std::max(silence.turn_rad, journey.turn_error_rad());
  }
  journey.lidar_is_silent = false;
  return silence;
}

struct Carrier {
  bool imu, wheel;
  int sweeps;
};

class SilentLidar : public testing::TestWithParam<Carrier> {};

// Given a robot on its way whose LiDAR is silent for a while; then its path goes on near the truth, nothing is mapped,
// its doubt grows, and the first sweep that comes again holds the pose.
TEST_P(SilentLidar, IsBridgedByTheOthers) {
  InertialJourney journey(test::driving_about(), inertial_setup(GetParam().imu, GetParam().wheel));
  see(journey, 30);
  const double known = journey.odometry->outcome().covariance.trace();
  const std::uint32_t layers = journey.odometry->map().window(0).layer_count();
  const Silence silence = fall_silent(journey, GetParam().sweeps);
  EXPECT_EQ(silence.carried, GetParam().sweeps);
  EXPECT_LT(silence.shift_m, 0.08);
  EXPECT_LT(silence.turn_rad, 0.03);
  EXPECT_EQ(journey.odometry->map().window(0).layer_count(), layers);
  EXPECT_GT(journey.odometry->outcome().covariance.trace(), 2 * known);
  const SweepOutcome& after = journey.sweep();
  EXPECT_TRUE(after.tracked);
  EXPECT_FALSE(after.carried);
  EXPECT_LT(journey.shift_error_m(), 0.02);
  EXPECT_LT(journey.turn_error_rad(), 0.01);
}

INSTANTIATE_TEST_SUITE_P(By, SilentLidar,
                         testing::Values(Carrier{true, false, 1}, Carrier{true, false, 10}, Carrier{false, true, 10},
                                         Carrier{true, true, 20}),
                         [](const auto& param) {
                           return std::string(param.param.imu ? "Imu" : "") + (param.param.wheel ? "Wheels" : "") +
                                  std::to_string(param.param.sweeps);
                         });

TEST(SilentLidarAlone, IsNoSweep) {
  InertialJourney journey(test::driving_about(), inertial_setup(false, false));
  see(journey, 10);
  EXPECT_EQ(fall_silent(journey, 3).carried, 0);
  EXPECT_EQ(journey.odometry->outcome().rejection, SweepRejection::too_few_points);
}

// Given a LiDAR that is gone for good; then the IMU carries the pose on until its doubt is some metres, and no farther.
TEST(SilentLidarAlone, AnImuDoesNotCarryForEver) {
  constexpr int kLong = 600;
  InertialJourney journey(test::driving_about(), inertial_setup(true, false));
  see(journey, 30);
  const Silence silence = fall_silent(journey, kLong);
  EXPECT_GT(silence.carried, 20);
  EXPECT_LT(silence.carried, kLong);
  EXPECT_LT(silence.shift_m, 20);
}

TEST(SilentLidarAlone, BeforeTheFirstSweepIsNoBeginning) {
  InertialJourney journey(test::driving_about(), inertial_setup(true, true));
  EXPECT_EQ(fall_silent(journey, 2).carried, 0);
}

}  // namespace
}  // namespace lxd::estimator_odometry_silence_test
