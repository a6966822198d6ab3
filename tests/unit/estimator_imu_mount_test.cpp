// SPDX-License-Identifier: Apache-2.0
// An IMU that is turned against what its rig file says: found as far as the carrier's turns show it, and used.
#include <gtest/gtest.h>

#include "estimator/ieskf.hpp"
#include "estimator/imu_mount.hpp"
#include "tests/support/inertial_journey.hpp"

namespace lxd::estimator_imu_mount_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::InertialJourney;

constexpr double kSigma_rad = 0.01;
constexpr double kChiSquare3 = 16.27;  // one in a thousand is beyond it

// Given readings of a walk, and the same ones turned a little, when a state is carried on by either over a sweep, then
// the two differ by the turn times what the filter says of it.
TEST(ImuMount, TheStateErrsByItAsItSays) {
  constexpr double kTurn_rad = 1e-4, kPeriod_s = 0.0025;
  const test::InertialMotion way = test::walking_about();
  const State x = way.state(3.5);
  for (int axis = 0; axis < 3; ++axis) {
    const Matrix3d R = Exp(kTurn_rad * Vector3d::Unit(axis));
    Ieskf right({}, ImuMount(kSigma_rad)), wrong({}, ImuMount(kSigma_rad));
    for (Ieskf* filter : {&right, &wrong}) filter->reset(x, StateMatrix::Identity());
    for (double t_s = 3.5; t_s < 3.6; t_s += kPeriod_s) {
      const InertialReading reading = way.reading(t_s);
      wrong.predict({kPeriod_s, reading.rate_radps, reading.force_mps2}, test::kJourneyNoise);
      right.predict({kPeriod_s, R * reading.rate_radps, R * reading.force_mps2}, test::kJourneyNoise);
    }
    const StateVector found = boxminus(right.state(), wrong.state()) / kTurn_rad;
    const StateVector said = wrong.mount().state_by_turn().col(axis);
    EXPECT_GT(said.segment<3>(kVelocity).norm(), axis == 2 ? 0.01 : 0.5);
    EXPECT_LT((found - said).norm(), 1e-3 * said.norm()) << found.transpose() << "\n" << said.transpose();
  }
}

// The IMU of a walk through a room says what one says that is turned by e.
InertialJourney walked(const Vector3d& e, double sigma_rad) {
  OdometrySetup setup = test::inertial_setup();
  setup.imu->rotation_sigma_rad = sigma_rad;
  InertialJourney journey(test::walking_about(), setup);
  journey.fault = [R = Exp(e)](double, InertialReading& reading) {
    reading.rate_radps = (R.transpose() * reading.rate_radps).eval();
    reading.force_mps2 = (R.transpose() * reading.force_mps2).eval();
    return true;
  };
  for (int i = 0; i < 120; ++i) journey.sweep();
  return journey;
}

TEST(ImuMount, AnImuThatIsTurnedOnItsCarrierIsFoundWhileWalking) {
  for (const Vector3d& e : {Vector3d(0, 0, 0), Vector3d(0.01, 0.01, -0.01), Vector3d(-0.02, 0.02, 0.02)}) {
    InertialJourney journey = walked(e, kSigma_rad);
    const ImuMount& found = journey.odometry->imu_mount();
    const Vector3d error = found.turned_rad() - e;
    EXPECT_LT(error.head<2>().norm(), 0.002) << error.transpose();  // the walk turns about z, which does not tell z
    EXPECT_LT(std::abs(error.z()), 0.006) << error.transpose();
    EXPECT_LT(error.dot(found.covariance_rad2().ldlt().solve(error)), kChiSquare3) << error.transpose();
    EXPECT_LT(std::sqrt(found.covariance_rad2().trace()), 0.4 * std::sqrt(3) * kSigma_rad);
  }
}

TEST(ImuMount, WhatTheRigFileSaysExactlyIsBelieved) {
  InertialJourney journey = walked({0.01, 0, 0}, 0);
  EXPECT_TRUE(journey.odometry->imu_mount().known());
  EXPECT_EQ(journey.odometry->imu_mount().turned_rad().norm(), 0);
}

}  // namespace
}  // namespace lxd::estimator_imu_mount_test
