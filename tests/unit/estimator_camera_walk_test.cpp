// SPDX-License-Identifier: Apache-2.0
// A walk with a camera whose stamps are late, or which is not mounted as the rig file says: the odometry finds both on
// its way.
#include <cmath>

#include <gtest/gtest.h>

#include "tests/support/feature_scene.hpp"
#include "tests/support/inertial_journey.hpp"

namespace lxd::estimator_camera_walk_test {
namespace {

using Eigen::Vector3d;

constexpr double kSigma_s = 0.005, kDegree_rad = M_PI / 180, kClaimed_rad = 0.5 * kDegree_rad;

// About a room whose walls have features, which a camera follows.
class Walk {
 public:
  explicit Walk(bool imu, double late_s, const Vector3d& turned_deg = Vector3d::Zero())
      : late_s_(late_s),
        T_body_camera_{Exp(turned_deg * kDegree_rad) * test::FeatureScene::forward().R,
                       test::FeatureScene::forward().p},
        journey_(test::walking_about(), setup(imu)) {
    test::StateChance chance(2);
    for (int i = 0; i < 900; ++i) {
      Vector3d p = chance.vector(1).normalized();
      p *= *test::Room().range_m(Vector3d::Zero(), p);
      points_.push_back(p);
    }
  }

  const CameraAlignment& after(int sweeps) {
    for (int i = 0; i < sweeps; ++i) {
      journey_.odometry->add(image(journey_.begin_s + 0.04));
      journey_.sweep();
    }
    return journey_.odometry->vision()->alignment();
  }
  double shift_error_m() { return journey_.shift_error_m(); }

 private:
  static OdometrySetup setup(bool imu) {
    OdometrySetup setup = test::inertial_setup(imu);
    setup.camera =
        MountedCamera{CameraModel(test::radtan_camera()), test::FeatureScene::forward(), 0, kSigma_s, kClaimed_rad};
    return setup;
  }

  FeatureFrame image(double taken_s) {
    FeatureFrame frame;
    frame.stamp = RigTime::from_seconds(taken_s + late_s_);
    const CameraModel camera(test::radtan_camera());
    const Pose T_camera_world = (journey_.way.pose(taken_s) * T_body_camera_).inverse();
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
  Pose T_body_camera_;
  test::InertialJourney journey_;
  std::vector<Vector3d> points_;
  test::StateChance chance_{4};
};

TEST(CameraWalk, WithAnImuTheDelayIsFound) {
  for (const double late_s : {0.0, 0.02, -0.015}) {
    Walk walk(true, late_s);
    const CameraAlignment& found = walk.after(80);
    EXPECT_NEAR(found.delay_s(), late_s, 1.5e-3) << late_s;
    EXPECT_LT(std::abs(found.delay_s() - late_s), 5 * found.delay_sigma_s()) << late_s;
    EXPECT_LT(walk.shift_error_m(), 0.02) << late_s;
  }
}

TEST(CameraWalk, WithoutAnImuTheDelayIsFound) {
  for (const double late_s : {0.0, 0.02, -0.015}) {
    Walk walk(false, late_s);
    const CameraAlignment& found = walk.after(120);
    EXPECT_NEAR(found.delay_s(), late_s, 4e-3) << late_s;
    EXPECT_LT(std::abs(found.delay_s() - late_s), 5 * found.delay_sigma_s()) << late_s;
  }
}

// Given a mount that is wrong by one degree and a half, when somebody has looked around for some seconds, then it is
// known as far as the turns tell it, and the path is none the worse. Without an IMU nodding is not measured well enough
// to tell what the camera is turned by about the vertical.
TEST(CameraWalk, TheMountIsFound) {
  const Vector3d turned_deg(0.9, -0.9, 0.8);
  for (const bool imu : {true, false}) {
    Walk walk(imu, 0, turned_deg);
    const CameraAlignment& found = walk.after(imu ? 80 : 120);
    const Vector3d off_rad = found.turned_rad() - kDegree_rad * turned_deg;
    EXPECT_LT(off_rad.head(imu ? 3 : 2).norm(), 0.4 * kDegree_rad) << imu << ": " << off_rad.transpose() / kDegree_rad;
    EXPECT_LT(off_rad.dot(found.turned_covariance_rad2().inverse() * off_rad), 25) << imu;
    EXPECT_LT(walk.shift_error_m(), 0.02) << imu;
  }
}

}  // namespace
}  // namespace lxd::estimator_camera_walk_test
