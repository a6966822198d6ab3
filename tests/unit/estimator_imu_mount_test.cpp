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
const Matrix3d kNoise = 1e-8 * Matrix3d::Identity();

// Turns of half a second about these axes, in turn; what the filter says of an IMU turned by `e`.
ImuMount turned_about(const std::vector<Vector3d>& turns, const Vector3d& e) {
  ImuMount mount(kSigma_rad);
  for (int i = 0; i < 400; ++i) {
    const Matrix3d T = Exp(turns[static_cast<std::size_t>(i) % turns.size()]);
    const Matrix3d& R = mount.R_body_imu();
    const Matrix3d read = Exp(e).transpose() * T * Exp(e);  // in the IMU's own axes
    mount.compare(RigTime::from_seconds(i), RigTime::from_seconds(i + 0.5), T, R * read * R.transpose(), kNoise);
  }
  return mount;
}

TEST(ImuMount, TurnsAboutTwoAxesTellAll) {
  const Vector3d e(0.012, -0.02, 0.015);
  const ImuMount found = turned_about({{0.3, 0, 0.1}, {0, 0.2, -0.1}, {-0.2, 0.1, 0}}, e);
  EXPECT_LT((found.turned_rad() - e).norm(), 5e-4);
  EXPECT_LT(found.covariance_rad2().trace(), 1e-6);
}

// A vehicle on a plane: how the IMU's axis stands to that of the turns is found, about that axis nothing is.
TEST(ImuMount, OnAPlaneTheTiltIsFoundAndTheHeadingStaysDoubted) {
  const Vector3d e(0.012, -0.02, 0.015);
  const ImuMount found = turned_about({{0, 0, 0.3}, {0, 0, -0.2}}, e);
  EXPECT_LT((found.turned_rad() - e).head<2>().norm(), 1e-3);
  EXPECT_LT(std::abs(found.turned_rad().z()), 2e-3);
  EXPECT_LT(found.covariance_rad2()(0, 0), 1e-6);
  EXPECT_GE(found.covariance_rad2()(2, 2), 0.9 * kSigma_rad * kSigma_rad);
}

TEST(ImuMount, RestTellsNothing) {
  const ImuMount found = turned_about({Vector3d::Zero()}, {0.02, 0, 0});
  EXPECT_EQ(found.turned_rad().norm(), 0);
  EXPECT_GE(found.covariance_rad2()(0, 0), kSigma_rad * kSigma_rad);
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
    const ImuMount& found = journey.odometry->motion().imu_mount();
    EXPECT_LT((found.turned_rad() - e).norm(), 0.004) << e.transpose() << " " << found.turned_rad().transpose();
    EXPECT_LT(std::sqrt(found.covariance_rad2().trace()), 0.005);
  }
}

TEST(ImuMount, WhatTheRigFileSaysExactlyIsBelieved) {
  InertialJourney journey = walked({0.01, 0, 0}, 0);
  EXPECT_TRUE(journey.odometry->motion().imu_mount().known());
  EXPECT_EQ(journey.odometry->motion().imu_mount().turned_rad().norm(), 0);
}

}  // namespace
}  // namespace lxd::estimator_imu_mount_test
