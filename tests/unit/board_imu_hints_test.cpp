// SPDX-License-Identifier: Apache-2.0
// Wrong units, signs and clocks of an IMU get a sentence; a sound one gets none.
#include <algorithm>
#include <functional>

#include <gtest/gtest.h>

#include "board/imu_hints.hpp"
#include "tests/support/inertial_journey.hpp"

namespace lxd::board_imu_hints_test {
namespace {

using test::inertial_setup;
using test::InertialJourney;

constexpr int kSweeps = 12;

// A walk whose IMU says what `mistake` makes of its samples, and what is said of it; the reference is turned against
// the body by R_body_reference.
std::vector<std::string> hints_of(const std::function<void(RigTime&, ImuSample&)>& mistake,
                                  const Eigen::Matrix3d& R_body_reference = Eigen::Matrix3d::Identity(),
                                  int sweeps = kSweeps) {
  ImuHints hints;
  Star star;
  star.T_body_reference.R = R_body_reference;
  OdometrySetup setup = inertial_setup(true, false);
  setup.imu->delay_sigma_s = 0.005;
  setup.imu->rotation_sigma_rad = 0.01;
  InertialJourney journey(test::walking_about(), setup);
  journey.fault = [&](double t_s, InertialReading& reading) {
    ImuSample sample;
    sample.gyro_radps = reading.rate_radps;
    sample.accel_mps2 = reading.force_mps2;
    RigTime t = RigTime::from_seconds(t_s);
    mistake(t, sample);
    hints.note(t, sample);
    reading = {t, sample.gyro_radps, sample.accel_mps2};
    return true;
  };
  for (int i = 0; i < sweeps; ++i) {
    const double begin_s = journey.begin_s;
    journey.sweep();
    hints.note(RigTime::from_seconds(begin_s), RigTime::from_seconds(journey.begin_s), journey.odometry.odometry, star);
  }
  return hints.sentences();
}

bool says(const std::vector<std::string>& sentences, const std::string& what) {
  return std::ranges::any_of(sentences, [&](const std::string& s) { return s.find(what) != std::string::npos; });
}

TEST(ImuHints, ASoundImuHasNone) {
  EXPECT_TRUE(hints_of([](RigTime&, ImuSample&) {}).empty());
}

TEST(ImuHints, ForceInGIsTold) {
  const auto hints = hints_of([](RigTime&, ImuSample& s) { s.accel_mps2 /= 9.80665; });
  EXPECT_TRUE(says(hints, "is it in g?")) << hints.size();
}

TEST(ImuHints, RatesInDegreesAreTold) {
  EXPECT_TRUE(says(hints_of([](RigTime&, ImuSample& s) { s.gyro_radps *= 57.29578; }), "degrees"));
}

TEST(ImuHints, MillisecondsForSecondsAreTold) {
  const auto hints = hints_of([](RigTime& t, ImuSample&) { t = RigTime::from_ns(1000 * t.ns()); });
  EXPECT_TRUE(says(hints, "wanted one clock, in seconds"));
}

TEST(ImuHints, AForceOfTheWrongSignIsTold) {
  EXPECT_TRUE(says(hints_of([](RigTime&, ImuSample& s) { s.accel_mps2 = -s.accel_mps2; }), "on its head"));
}

TEST(ImuHints, ReadingsThatComeTenMillisecondsLateAreToldWithTheirDelay) {
  const auto late = [](double late_s) {
    return hints_of([late_s](RigTime& t, ImuSample&) { t = t + Duration::from_seconds(late_s); },
                    Eigen::Matrix3d::Identity(), 4 * kSweeps);
  };
  EXPECT_TRUE(says(late(0.01), "later than the LiDAR's returns"));
  EXPECT_TRUE(says(late(0.01), "imu.delay_s: 0.01"));
  EXPECT_TRUE(late(0.001).empty());
}

TEST(ImuHints, ARigThatIsMountedUpsideDownIsTold) {
  const Eigen::Matrix3d upside_down = Eigen::Vector3d(1, -1, -1).asDiagonal();
  EXPECT_TRUE(says(hints_of([](RigTime&, ImuSample&) {}, upside_down), "on its head"));
}

TEST(ImuHints, AnImuThatIsTurnedByTwoDegreesIsToldWithItsTransform) {
  const Eigen::Matrix3d turned = Exp(Eigen::Vector3d(0.02, -0.02, 0.02));
  const auto mount = [&](RigTime&, ImuSample& s) {
    s.gyro_radps = turned * s.gyro_radps;
    s.accel_mps2 = turned * s.accel_mps2;
  };
  const auto hints = hints_of(mount, Eigen::Matrix3d::Identity(), 10 * kSweeps);
  EXPECT_TRUE(says(hints, "imu: it is turned by")) << hints.size();
  EXPECT_TRUE(says(hints, "put imu.T_reference_sensor: [["));
}

TEST(ImuHints, SilenceIsTold) {
  ImuHints hints;
  InertialJourney journey(test::walking_about(), inertial_setup(false, false));
  journey.sweep();
  hints.note(RigTime::from_seconds(1), RigTime::from_seconds(2), journey.odometry.odometry, Star());
  EXPECT_TRUE(says(hints.sentences(), "nothing was heard"));
}

}  // namespace
}  // namespace lxd::board_imu_hints_test
