// SPDX-License-Identifier: Apache-2.0
// The camera's clock against the LiDAR's: found from the turns between images, with an IMU and without, and left alone
// where nothing tells it.
#include <cmath>

#include <gtest/gtest.h>

#include "estimator/vision/camera_delay.hpp"
#include "tests/support/feature_scene.hpp"
#include "tests/support/inertial_journey.hpp"

namespace lxd::estimator_camera_delay_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kPeriod_s = 0.1, kSigma_s = 0.005, kTurnSigma_rad = 3e-4, kMost_s = 0.05;

Duration seconds(double s) { return Duration::from_seconds(s); }

// A camera on its way, which sees turns with some noise and stamps them late.
class LateCamera {
 public:
  LateCamera(test::InertialMotion its_way, double late_s) : way(std::move(its_way)), late_s_(late_s) {}

  [[nodiscard]] std::optional<Matrix3d> turn(RigTime then, RigTime now) const {
    return way.pose(then.seconds()).R.transpose() * way.pose(now.seconds()).R;
  }
  ImageTurn next() {
    ImageTurn seen{taken_ + seconds(late_s_), taken_ + seconds(kPeriod_s + late_s_)};
    seen.covariance_rad2 = kTurnSigma_rad * kTurnSigma_rad * Matrix3d::Identity();
    seen.R_then_now = *turn(taken_, taken_ + seconds(kPeriod_s)) * Exp(chance.vector(kTurnSigma_rad));
    taken_ = taken_ + seconds(kPeriod_s);
    return seen;
  }

  // Its turns held against the true path, or against what the LiDAR found at the ends of sweeps.
  void watch(CameraDelay& delay, int images) {
    for (int i = 0; i < images; ++i) {
      delay.pass(seconds(kPeriod_s));
      delay.compare(next(), [this](RigTime then, RigTime now) { return turn(then, now); });
    }
  }
  void watch_by_lidar(CameraDelay& delay, int images) {
    for (int i = 0; i < images; ++i) {
      const ImageTurn seen = next();
      const RigTime end = taken_ + seconds(0.03);
      delay.pass(seconds(kPeriod_s));
      delay.follow(end, way.pose(end.seconds()).R * Exp(chance.vector(kTurnSigma_rad)), &seen);
    }
  }

  test::InertialMotion way;
  test::StateChance chance{8};

 private:
  double late_s_;
  RigTime taken_ = RigTime::from_seconds(2);
};

TEST(CameraDelay, ItIsFoundHoweverLateOrEarlyTheStampsAre) {
  for (const double late_s : {0.0, 0.02, -0.015}) {
    CameraDelay delay(0, kSigma_s);
    LateCamera(test::walking_about(), late_s).watch(delay, 150);
    EXPECT_NEAR(delay.delay_s(), late_s, 1e-3) << late_s;
    EXPECT_LT(std::abs(delay.delay_s() - late_s), 4 * delay.sigma_s()) << late_s;
    EXPECT_LT(delay.sigma_s(), 1e-3);
  }
}

TEST(CameraDelay, WithoutAnImuTheSweepsBeforeAndAfterTellThePath) {
  for (const double late_s : {0.0, 0.02, -0.015}) {
    CameraDelay delay(0, kSigma_s);
    LateCamera(test::walking_about(), late_s).watch_by_lidar(delay, 250);
    EXPECT_NEAR(delay.delay_s(), late_s, 2e-3) << late_s;
    EXPECT_LT(std::abs(delay.delay_s() - late_s), 4 * delay.sigma_s()) << late_s;
  }
}

// Standing, and in a steady turn: sigma grows by the clocks' walk alone.
TEST(CameraDelay, WhoStandsOrTurnsSteadilyLearnsNothing) {
  for (const auto& way : {test::resting(), test::steady({1, 0, 0}, 0.8)}) {
    CameraDelay delay(0.001, kSigma_s);
    LateCamera(way, 0.02).watch(delay, 600);
    EXPECT_EQ(delay.delay_s(), 0.001);
    EXPECT_GE(delay.sigma_s(), kSigma_s);
    EXPECT_LT(delay.sigma_s(), 1.01 * kSigma_s);
  }
}

TEST(CameraDelay, WhatIsKnownExactlyStays) {
  CameraDelay delay(0.003, 0);
  LateCamera(test::walking_about(), 0.02).watch(delay, 100);
  EXPECT_TRUE(delay.known());
  EXPECT_EQ(delay.delay_s(), 0.003);
}

TEST(CameraDelay, ItStaysWithinWhatIsBelieved) {
  for (const double late_s : {0.09, -0.09}) {
    CameraDelay delay(0, 0.02);
    LateCamera(test::walking_about(), late_s).watch(delay, 300);
    EXPECT_LE(std::abs(delay.delay_s()), kMost_s);
  }
}

// Something large goes by before the camera: one turn of four is another's.
TEST(CameraDelay, WrongTurnsMoveItLittle) {
  CameraDelay delay(0, kSigma_s);
  LateCamera camera(test::walking_about(), 0.02);
  for (int i = 0; i < 300; ++i) {
    ImageTurn seen = camera.next();
    if (i % 4 == 0) seen.R_then_now = seen.R_then_now * Exp(Vector3d(0.02, 0.03, -0.01));
    delay.compare(seen, [&](RigTime then, RigTime now) { return camera.turn(then, now); });
  }
  EXPECT_NEAR(delay.delay_s(), 0.02, 3e-3);
}

// Numbers that are none change nothing.
TEST(CameraDelay, NoNumbersAreNotLearntFrom) {
  CameraDelay delay(0, kSigma_s);
  LateCamera camera(test::walking_about(), 0.02);
  for (int i = 0; i < 20; ++i) {
    ImageTurn seen = camera.next();
    if (i % 2 == 0) seen.R_then_now(1, 1) = NAN;
    if (i % 2 == 1) seen.covariance_rad2(0, 0) = NAN;
    delay.compare(seen, [&](RigTime then, RigTime now) { return camera.turn(then, now); });
  }
  EXPECT_EQ(delay.delay_s(), 0);
  EXPECT_EQ(delay.sigma_s(), kSigma_s);
}

// A walk about a room whose walls have features, which a camera follows and stamps late.
class Walk {
 public:
  Walk(bool imu, double late_s) : late_s_(late_s), journey_(test::walking_about(), setup(imu)) {
    test::StateChance chance(2);
    for (int i = 0; i < 900; ++i) {
      Vector3d p = chance.vector(1).normalized();
      p *= *test::Room().range_m(Vector3d::Zero(), p);
      points_.push_back(p);
    }
  }

  const CameraDelay& after(int sweeps) {
    for (int i = 0; i < sweeps; ++i) {
      journey_.odometry->add(image(journey_.begin_s + 0.04));
      journey_.sweep();
    }
    return journey_.odometry->vision()->delay();
  }
  double shift_error_m() { return journey_.shift_error_m(); }

 private:
  static OdometrySetup setup(bool imu) {
    OdometrySetup setup = test::inertial_setup(imu);
    setup.camera = MountedCamera{CameraModel(test::radtan_camera()), test::FeatureScene::forward(), 0, kSigma_s};
    return setup;
  }

  FeatureFrame image(double taken_s) {
    FeatureFrame frame;
    frame.stamp = RigTime::from_seconds(taken_s + late_s_);
    const CameraModel camera(test::radtan_camera());
    const Pose T_camera_world = (journey_.way.pose(taken_s) * test::FeatureScene::forward()).inverse();
    for (std::size_t i = 0; i < points_.size() && frame.count < kFeaturesMax; ++i) {
      Eigen::Vector2d pixel;
      Vector3d b;
      if (!camera.project(T_camera_world * points_[i], pixel)) continue;
      pixel += 0.2 * Eigen::Vector2d(chance_.normal(), chance_.normal());
      if (!camera.contains(pixel, 5) || !camera.unproject(pixel, b)) continue;
      const Eigen::Vector3f bearing = b.cast<float>();
      const Eigen::Vector2f at = pixel.cast<float>();
      frame.storage[frame.count++] = {
          static_cast<std::uint32_t>(i + 1), 0, {at.x(), at.y()}, {bearing.x(), bearing.y(), bearing.z()}};
    }
    return frame;
  }

  double late_s_;
  test::InertialJourney journey_;
  std::vector<Vector3d> points_;
  test::StateChance chance_{4};
};

TEST(CameraDelay, AWalkWithAnImuFindsIt) {
  for (const double late_s : {0.0, 0.02, -0.015}) {
    Walk walk(true, late_s);
    const CameraDelay& found = walk.after(80);
    EXPECT_NEAR(found.delay_s(), late_s, 1.5e-3) << late_s;
    EXPECT_LT(std::abs(found.delay_s() - late_s), 5 * found.sigma_s()) << late_s;
    EXPECT_LT(walk.shift_error_m(), 0.02) << late_s;
  }
}

TEST(CameraDelay, AWalkWithoutAnImuFindsIt) {
  for (const double late_s : {0.0, 0.02, -0.015}) {
    Walk walk(false, late_s);
    const CameraDelay& found = walk.after(120);
    EXPECT_NEAR(found.delay_s(), late_s, 4e-3) << late_s;
    EXPECT_LT(std::abs(found.delay_s() - late_s), 5 * found.sigma_s()) << late_s;
  }
}

}  // namespace
}  // namespace lxd::estimator_camera_delay_test
