// SPDX-License-Identifier: Apache-2.0
// An IMU that is turned against what its rig file says: found as far as the carrier's turns show it, and used.
#include <gtest/gtest.h>

#include "estimator/imu_mount.hpp"
#include "tests/support/inertial_journey.hpp"

namespace lxd::estimator_imu_mount_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using test::InertialJourney;

constexpr double kSigma_rad = 0.01;
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
    EXPECT_LT((found.turned_rad() - e).norm(), 0.004) << e.transpose() << " " << found.turned_rad().transpose();
    EXPECT_LT(std::sqrt(found.covariance_rad2().trace()), 0.005);
  }
}

TEST(ImuMount, WhatTheRigFileSaysExactlyIsBelieved) {
  InertialJourney journey = walked({0.01, 0, 0}, 0);
  EXPECT_TRUE(journey.odometry->imu_mount().known());
  EXPECT_EQ(journey.odometry->imu_mount().turned_rad().norm(), 0);
}

}  // namespace
}  // namespace lxd::estimator_imu_mount_test
