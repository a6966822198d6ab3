// SPDX-License-Identifier: Apache-2.0
// The camera's clock against the LiDAR's, and how it is turned on its carrier: found from the turns between images,
// with an IMU and without, and left alone where nothing tells it.
#include <cmath>

#include <gtest/gtest.h>

#include "estimator/vision/camera_alignment.hpp"
#include "tests/support/feature_scene.hpp"
#include "tests/support/inertial_journey.hpp"

namespace lxd::estimator_camera_alignment_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPeriod_s = 0.1, kSigma_s = 0.005, kTurnSigma_rad = 3e-4, kMost_s = 0.05;

constexpr double kDegree_rad = M_PI / 180;
const Vector3d kStraight = Vector3d::Zero();

Duration seconds(double s) { return Duration::from_seconds(s); }

MountedCamera by_rig_file(double delay_s, double delay_sigma_s, double rotation_sigma_deg = 0) {
  return {CameraModel(test::radtan_camera()), test::FeatureScene::forward(), delay_s, delay_sigma_s,
          rotation_sigma_deg * kDegree_rad};
}

// A camera on its way, which sees turns with some noise, stamps them late, and is turned on its carrier.
class LateCamera {
 public:
  LateCamera(test::InertialMotion its_way, double late_s, const Vector3d& turned_deg = kStraight)
      : way(std::move(its_way)),
        late_s_(late_s),
        R_body_camera_(Exp(turned_deg * kDegree_rad) * test::FeatureScene::forward().R) {}

  [[nodiscard]] std::optional<Matrix3d> turn(RigTime then, RigTime now) const {
    return way.pose(then.seconds()).R.transpose() * way.pose(now.seconds()).R;
  }
  ImageTurn next() {
    ImageTurn seen{taken_ + seconds(late_s_), taken_ + seconds(kPeriod_s + late_s_)};
    seen.covariance_rad2 = kTurnSigma_rad * kTurnSigma_rad * Matrix3d::Identity();
    const Matrix3d body = *turn(taken_, taken_ + seconds(kPeriod_s));
    seen.R_then_now = R_body_camera_.transpose() * body * R_body_camera_ * Exp(chance.vector(kTurnSigma_rad));
    taken_ = taken_ + seconds(kPeriod_s);
    return seen;
  }

  // Its turns held against the true path, or against what the LiDAR found at the ends of sweeps.
  void watch(CameraAlignment& alignment, int images) {
    for (int i = 0; i < images; ++i) {
      alignment.pass(seconds(kPeriod_s));
      alignment.compare(next(), [this](RigTime then, RigTime now) { return turn(then, now); });
    }
  }
  void watch_by_lidar(CameraAlignment& alignment, int images) {
    for (int i = 0; i < images; ++i) {
      const ImageTurn seen = next();
      const RigTime end = taken_ + seconds(0.03);
      alignment.pass(seconds(kPeriod_s));
      alignment.follow(end, way.pose(end.seconds()).R * Exp(chance.vector(kTurnSigma_rad)), &seen);
    }
  }

  test::InertialMotion way;
  test::StateChance chance{8};

 private:
  double late_s_;
  Matrix3d R_body_camera_;
  RigTime taken_ = RigTime::from_seconds(2);
};

TEST(CameraAlignment, TheDelayIsFoundHoweverLateOrEarlyTheStampsAre) {
  for (const double late_s : {0.0, 0.02, -0.015}) {
    CameraAlignment delay(by_rig_file(0, kSigma_s));
    LateCamera(test::walking_about(), late_s).watch(delay, 150);
    EXPECT_NEAR(delay.delay_s(), late_s, 1e-3) << late_s;
    EXPECT_LT(std::abs(delay.delay_s() - late_s), 4 * delay.delay_sigma_s()) << late_s;
    EXPECT_LT(delay.delay_sigma_s(), 1e-3);
  }
}

TEST(CameraAlignment, WithoutAnImuTheSweepsBeforeAndAfterTellTheDelay) {
  for (const double late_s : {0.0, 0.02, -0.015}) {
    CameraAlignment delay(by_rig_file(0, kSigma_s));
    LateCamera(test::walking_about(), late_s).watch_by_lidar(delay, 250);
    EXPECT_NEAR(delay.delay_s(), late_s, 2e-3) << late_s;
    EXPECT_LT(std::abs(delay.delay_s() - late_s), 4 * delay.delay_sigma_s()) << late_s;
  }
}

// Standing, and in a steady turn: sigma grows by the clocks' walk alone.
TEST(CameraAlignment, WhoStandsOrTurnsSteadilyLearnsNothing) {
  for (const auto& way : {test::resting(), test::steady({1, 0, 0}, 0.8)}) {
    CameraAlignment delay(by_rig_file(0.001, kSigma_s));
    LateCamera(way, 0.02).watch(delay, 600);
    EXPECT_EQ(delay.delay_s(), 0.001);
    EXPECT_GE(delay.delay_sigma_s(), kSigma_s);
    EXPECT_LT(delay.delay_sigma_s(), 1.01 * kSigma_s);
  }
}

TEST(CameraAlignment, WhatIsKnownExactlyStays) {
  CameraAlignment delay(by_rig_file(0.003, 0));
  LateCamera(test::walking_about(), 0.02).watch(delay, 100);
  EXPECT_TRUE(delay.known());
  EXPECT_EQ(delay.delay_s(), 0.003);
}

TEST(CameraAlignment, TheDelayStaysWithinWhatIsBelieved) {
  for (const double late_s : {0.09, -0.09}) {
    CameraAlignment delay(by_rig_file(0, 0.02));
    LateCamera(test::walking_about(), late_s).watch(delay, 300);
    EXPECT_LE(std::abs(delay.delay_s()), kMost_s);
  }
}

// Something large goes by before the camera: one turn of four is another's.
TEST(CameraAlignment, WrongTurnsMoveTheDelayLittle) {
  CameraAlignment delay(by_rig_file(0, kSigma_s));
  LateCamera camera(test::walking_about(), 0.02);
  for (int i = 0; i < 300; ++i) {
    ImageTurn seen = camera.next();
    if (i % 4 == 0) seen.R_then_now = seen.R_then_now * Exp(Vector3d(0.02, 0.03, -0.01));
    delay.compare(seen, [&](RigTime then, RigTime now) { return camera.turn(then, now); });
  }
  EXPECT_NEAR(delay.delay_s(), 0.02, 3e-3);
}

// Numbers that are none change nothing.
TEST(CameraAlignment, NoNumbersAreNotLearntFrom) {
  CameraAlignment delay(by_rig_file(0, kSigma_s));
  LateCamera camera(test::walking_about(), 0.02);
  for (int i = 0; i < 20; ++i) {
    ImageTurn seen = camera.next();
    if (i % 2 == 0) seen.R_then_now(1, 1) = NAN;
    if (i % 2 == 1) seen.covariance_rad2(0, 0) = NAN;
    delay.compare(seen, [&](RigTime then, RigTime now) { return camera.turn(then, now); });
  }
  EXPECT_EQ(delay.delay_s(), 0);
  EXPECT_EQ(delay.delay_sigma_s(), kSigma_s);
}

// Given a delay and a mount that are off, then the row's derivatives are those of what the images' turn lacks.
TEST(CameraAlignment, TheRowIsTheDerivativeOfWhatTheImagesTurnLacks) {
  constexpr double kStep_s = 1e-5, kStep_rad = 1e-5;
  const LateCamera camera(test::walking_about(), 0);
  const auto path = [&](double earlier_s) {
    return *camera.turn(RigTime::from_seconds(2.3 - earlier_s), RigTime::from_seconds(2.4 - earlier_s));
  };
  const auto lacking = [&](double late_s, const Vector3d& turned_rad) {
    return turn_row(path(0), path(CameraAlignment::kEarlier.seconds()),
                    Exp(-turned_rad) * path(late_s) * Exp(turned_rad))
        .lacking;
  };
  const TurnRow row = turn_row(path(0), path(CameraAlignment::kEarlier.seconds()), path(0));
  EXPECT_LT(row.lacking.norm(), 1e-12);
  const Vector3d by_delay = (lacking(kStep_s, kStraight) - lacking(-kStep_s, kStraight)) / (2 * kStep_s);
  EXPECT_LT((row.by.col(0) - by_delay).norm(), 0.1 * by_delay.norm());  // its step is 10 ms long
  for (int axis = 0; axis < 3; ++axis) {
    const Vector3d step = kStep_rad * Vector3d::Unit(axis);
    EXPECT_LT((row.by.col(1 + axis) - (lacking(0, step) - lacking(0, -step)) / (2 * kStep_rad)).norm(), 1e-8) << axis;
  }
}

// About each axis as well as the walker's turns tell it; late images do not look like a turned camera.
TEST(CameraAlignment, TheMountIsFoundWithTheDelay) {
  for (const Vector3d& turned_deg : {kStraight, Vector3d(0.6, -0.5, 0.4), Vector3d(-2, 1, 1.5)})
    for (const double late_s : {0.0, 0.02}) {
      CameraAlignment found(by_rig_file(0, kSigma_s, 0.5));
      LateCamera(test::walking_about(), late_s, turned_deg).watch(found, 400);
      const Vector3d off_rad = found.turned_rad() - kDegree_rad * turned_deg;
      const Eigen::Matrix3d P = found.turned_covariance_rad2();
      EXPECT_LT(off_rad.norm(), 0.15 * kDegree_rad) << turned_deg.transpose() << " late " << late_s;
      EXPECT_LT(off_rad.dot(P.inverse() * off_rad), 25) << turned_deg.transpose() << " late " << late_s;
      EXPECT_LT(P.trace(), std::pow(0.2 * kDegree_rad, 2));
      EXPECT_NEAR(found.delay_s(), late_s, 1e-3);
    }
}

// A vehicle on a plane: what its camera is turned by about the vertical no turn tells.
TEST(CameraAlignment, TurnsAboutOneAxisTellTheOthersOnly) {
  const Vector3d turned_deg(0.6, -0.5, 0.4);
  CameraAlignment found(by_rig_file(0, kSigma_s, 0.5));
  LateCamera(test::steady({1, 0, 0}, 0.8), 0, turned_deg).watch(found, 400);
  EXPECT_LT((found.turned_rad() - kDegree_rad * turned_deg).head<2>().norm(), 0.1 * kDegree_rad);
  EXPECT_NEAR(found.turned_rad().z(), 0, 0.05 * kDegree_rad);
  EXPECT_GT(std::sqrt(found.turned_covariance_rad2()(2, 2)), 0.45 * kDegree_rad);
}

TEST(CameraAlignment, AMountThatIsKnownExactlyStays) {
  CameraAlignment found(by_rig_file(0, kSigma_s, 0));
  LateCamera(test::walking_about(), 0, {2, 0, 0}).watch(found, 100);
  EXPECT_EQ(found.R_body_camera(), test::FeatureScene::forward().R);
  EXPECT_FALSE(found.known());
}

// An extrinsic that is none, such as its inverse: it is not followed wherever the turns lead.
TEST(CameraAlignment, TheMountStaysWithinWhatIsBelieved) {
  CameraAlignment found(by_rig_file(0, kSigma_s, 5));
  LateCamera(test::walking_about(), 0, {0, 60, 0}).watch(found, 400);
  EXPECT_LT(found.turned_rad().norm(), 10 * kDegree_rad);
  EXPECT_GT(found.unlike(), 0.5);
  CameraAlignment nearly(by_rig_file(0, kSigma_s, 0.5));
  LateCamera(test::walking_about(), 0, {0, 2, 0}).watch(nearly, 400);
  EXPECT_LT(nearly.unlike(), 0.01);
}

}  // namespace
}  // namespace lxd::estimator_camera_alignment_test
