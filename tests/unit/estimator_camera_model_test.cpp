// SPDX-License-Identifier: Apache-2.0
// The estimator's camera: its projection against the formula, its derivative against differences, its inverse, and
// where it says no.
#include <cmath>

#include <gtest/gtest.h>

#include "estimator/vision/camera_model.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/property.hpp"

namespace lxd::estimator_camera_model_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

class CameraModels : public testing::TestWithParam<CameraIntrinsics (*)()> {
 protected:
  const CameraModel camera{GetParam()()};
};

INSTANTIATE_TEST_SUITE_P(Estimator, CameraModels,
                         testing::Values(&test::plain_camera, &test::radtan_camera, &test::fisheye_camera));

TEST_P(CameraModels, TheAxisIsTheCentre) {
  Vector2d pixel;
  ASSERT_TRUE(camera.project({0, 0, 3}, pixel));
  EXPECT_NEAR((pixel - camera.intrinsics().centre_px).norm(), 0, 1e-12);
}

TEST_P(CameraModels, TheDerivativeAgreesWithDifferences) {
  test::check_property([this] {
    const Vector3d p(test::uniform(-2, 2), test::uniform(-2, 2), test::uniform(1.5, 10));
    Vector2d pixel, plus, minus;
    ProjectionJacobian J;
    RC_PRE(camera.project(p, pixel, &J));
    constexpr double kStep = 1e-5;
    for (int i = 0; i < 3; ++i) {
      RC_ASSERT(camera.project(p + kStep * Vector3d::Unit(i), plus));
      RC_ASSERT(camera.project(p - kStep * Vector3d::Unit(i), minus));
      RC_ASSERT(((plus - minus) / (2 * kStep) - J.col(i)).norm() < 1e-6 * (1 + J.norm()));
    }
  });
}

// At the axis, where quotients vanish, the derivative is continuous.
TEST_P(CameraModels, TheDerivativeIsSoundAtTheAxis) {
  ProjectionJacobian at, beside;
  Vector2d pixel;
  for (const double r : {1e-12, 1e-7, 3e-6, 1e-4}) {
    ASSERT_TRUE(camera.project({0, 0, 2}, pixel, &at));
    ASSERT_TRUE(camera.project({r, -r, 2}, pixel, &beside));
    EXPECT_LT((at - beside).norm(), 200 * r + 1e-7) << r;
  }
}

TEST_P(CameraModels, UnprojectUndoesProject) {
  for (double u = 1; u < 640; u += 21.3)
    for (double v = 1; v < 480; v += 19.7) {
      Vector3d bearing;
      Vector2d pixel;
      ASSERT_TRUE(camera.unproject({u, v}, bearing)) << u << " " << v;
      EXPECT_NEAR(bearing.norm(), 1, 1e-12);
      ASSERT_TRUE(camera.project(7 * bearing, pixel));
      EXPECT_LT((pixel - Vector2d(u, v)).norm(), 1e-7);
    }
}

TEST_P(CameraModels, WhatIsNoPointIsRefused) {
  Vector2d pixel;
  Vector3d bearing;
  const double nan = std::nan("");
  EXPECT_FALSE(camera.project({nan, 0, 1}, pixel));
  EXPECT_FALSE(camera.project({0, 0, nan}, pixel));
  EXPECT_FALSE(camera.unproject({nan, 3}, bearing));
  EXPECT_FALSE(camera.project({0.1, 0, -5}, pixel));
  EXPECT_FALSE(camera.unproject({1e7, 3}, bearing) && !bearing.allFinite());
}

TEST(CameraModelTest, RadtanIsOpencvsFormula) {
  const CameraModel camera(test::radtan_camera());
  const auto& c = camera.intrinsics();
  const double x = 0.3, y = -0.2, q = x * x + y * y, k1 = c.coefficients[0], k2 = c.coefficients[1];
  const double p1 = c.coefficients[2], p2 = c.coefficients[3], s = 1 + k1 * q + k2 * q * q;
  Vector2d pixel;
  ASSERT_TRUE(camera.project({2 * x, 2 * y, 2}, pixel));
  EXPECT_NEAR(pixel.x(), 420 * (x * s + 2 * p1 * x * y + p2 * (q + 2 * x * x)) + 322, 1e-9);
  EXPECT_NEAR(pixel.y(), 425 * (y * s + p1 * (q + 2 * y * y) + 2 * p2 * x * y) + 241, 1e-9);
}

TEST(CameraModelTest, EquidistantIsTheAngle) {
  const CameraModel camera(test::fisheye_camera());
  const auto& k = camera.intrinsics().coefficients;
  const double a = 0.9,
               d = a + k[0] * std::pow(a, 3) + k[1] * std::pow(a, 5) + k[2] * std::pow(a, 7) + k[3] * std::pow(a, 9);
  Vector2d pixel;
  ASSERT_TRUE(camera.project({3 * std::sin(a), 0, 3 * std::cos(a)}, pixel));
  EXPECT_NEAR(pixel.x(), 322 + 190 * d, 1e-9);
}

// A strong barrel folds back: beyond the fold two points would share a pixel.
TEST(CameraModelTest, BeyondTheFoldThereIsNoPixel) {
  CameraIntrinsics barrel = test::radtan_camera();
  barrel.coefficients = {-0.3, 0, 0, 0};  // r (1 - 0.3 r^2) rises up to r = 1.054
  const CameraModel camera(barrel);
  Vector2d pixel;
  EXPECT_TRUE(camera.project({1.0, 0, 1}, pixel));
  EXPECT_FALSE(camera.project({1.1, 0, 1}, pixel));
  Vector3d bearing;
  EXPECT_FALSE(camera.unproject({322 + 420 * 0.75, 241}, bearing));
}

TEST(CameraModelTest, TheImageHasABorder) {
  const CameraModel camera(test::plain_camera());
  EXPECT_TRUE(camera.contains({0, 0}));
  EXPECT_TRUE(camera.contains({639, 479}));
  EXPECT_FALSE(camera.contains({639.1, 3}));
  EXPECT_FALSE(camera.contains({4, 100}, 5));
  EXPECT_FALSE(camera.contains({std::nan(""), 100}));
}

}  // namespace
}  // namespace lxd::estimator_camera_model_test
