// SPDX-License-Identifier: Apache-2.0
// A feature's inverse distance: the paper's filter, the change of anchor, what pixels say of it, and triangulation.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/vision/depth_filter.hpp"
#include "estimator/vision/triangulation.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/estimator_states.hpp"
#include "tests/support/property.hpp"

namespace lxd::estimator_depth_filter_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using test::StateChance;

constexpr double kNoGate = 1e9;

TEST(EstimatorDepthFilter, ADistanceIsTurnedOver) {
  const InverseDepth depth = inverse_of(4, 0.01);
  EXPECT_DOUBLE_EQ(depth.rho, 0.25);
  EXPECT_DOUBLE_EQ(depth.variance, 0.01 / 256);
}

TEST(EstimatorDepthFilter, TwoObservationsAreFusedByTheirVariance) {
  const InverseDepth both = fused({0.2, 0.02}, {0.3, 0.01});
  EXPECT_NEAR(both.rho, 0.2 + 2.0 / 3 * 0.1, 1e-12);
  EXPECT_NEAR(both.variance, 0.02 / 3, 1e-12);
  EXPECT_NEAR(squared_difference({0.2, 0.02}, {0.3, 0.01}), 1.0 / 3, 1e-12);
}

// However often a distance is confirmed, it is not known better than the poses.
TEST(EstimatorDepthFilter, TheVarianceHasAFloorAndTheDistanceBounds) {
  InverseDepth depth{0.5, 0.01};
  for (int i = 0; i < 10'000; ++i) depth = fused(depth, {0.5, 1e-4});
  EXPECT_NEAR(std::sqrt(depth.variance), 0.0015, 1e-9);
  EXPECT_EQ(fused({0.1, 1}, {-3, 1e-6}).rho, kInverseDistanceMin);
  EXPECT_EQ(inverse_of(1e-9, 1e-9).rho, kInverseDistanceMax);
}

// The point stays where it is, and the variance follows the numeric derivative.
TEST(EstimatorDepthFilter, ANewAnchorSeesTheSamePoint) {
  test::check_property(
      [] {
        StateChance chance(*rc::gen::arbitrary<unsigned>());
        const AnchoredPoint old{Vector3d(chance.normal(0.3), chance.normal(0.3), 1).normalized(),
                                {chance.uniform(0.05, 1), 0.01}};
        const Pose T{Exp(chance.vector(0.3)), chance.vector(0.2)};
        const auto moved = [&](double d) {
          AnchoredPoint point = old;
          point.depth.rho += d;
          return shifted(point, T);
        };
        const AnchoredPoint now = moved(0);
        const Vector3d expected = T * Vector3d(old.bearing / old.depth.rho);
        RC_ASSERT((now.bearing / now.depth.rho - expected).norm() < 1e-9 * expected.norm());
        constexpr double kStep = 1e-6;
        const double slope = (moved(kStep).depth.rho - moved(-kStep).depth.rho) / (2 * kStep);
        RC_ASSERT(std::abs(std::sqrt(now.depth.variance) - std::max(std::abs(slope) * 0.1, 0.003 * now.depth.rho)) <
                  1e-6);
      },
      300);
}

// A camera that moves sideways, half a pixel of noise in each image and in the anchor, from a vague start: the error is
// what the variance says (NEES), although all pixels share the anchor's error.
TEST(EstimatorDepthFilter, PixelsMeasureTheDistanceConsistently) {
  const CameraModel camera(test::radtan_camera());
  StateChance chance(4);
  constexpr int kRuns = 400, kImages = 12;
  double nees = 0, innovation = 0, shrunk = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Vector3d exact = Vector3d(chance.normal(0.2), chance.normal(0.2), 1).normalized();
    AnchoredPoint point{(exact + Vector3d(chance.normal(), chance.normal(), 0) * 0.5 / 420).normalized(), {0, 0.0004}};
    const double truth = chance.uniform(0.1, 0.3);
    point.depth.rho = truth + chance.normal(0.02);
    for (int i = 1; i <= kImages; ++i) {
      const Pose T{Exp(chance.vector(0.05)), Vector3d(0.03 * i, chance.normal(0.02), chance.normal(0.02))};
      Vector2d pixel;
      ASSERT_TRUE(camera.project(T * Vector3d(exact / truth), pixel));
      pixel += Vector2d(chance.normal(0.5), chance.normal(0.5));
      innovation += update_by_pixel(point, T, camera, pixel, 0.5 * std::numbers::sqrt2, kNoGate);
    }
    nees += std::pow(point.depth.rho - truth, 2) / point.depth.variance;
    shrunk += std::sqrt(point.depth.variance) / 0.02;
  }
  EXPECT_GT(nees / kRuns, 0.5);
  EXPECT_LT(nees / kRuns, 1.2);
  EXPECT_NEAR(innovation / (kRuns * kImages), 1.7, 0.5);  // below 2: the anchor's share is fitted
  EXPECT_LT(shrunk / kRuns, 0.4);
}

TEST(EstimatorDepthFilter, APixelBeyondTheGateChangesNothing) {
  const CameraModel camera(test::plain_camera());
  AnchoredPoint point{Vector3d::UnitZ(), {0.2, 1e-4}};
  const Pose T{Eigen::Matrix3d::Identity(), {-0.3, 0, 0}};
  EXPECT_GT(update_by_pixel(point, T, camera, {322, 300}, 0.5, 13.8), 13.8);
  EXPECT_EQ(point.depth.rho, 0.2);
  EXPECT_TRUE(std::isinf(update_by_pixel(point, T, camera, {NAN, 300}, 0.5, 13.8)));
  EXPECT_TRUE(std::isinf(update_by_pixel(point, {Exp({0, M_PI, 0}), {0, 0, 0}}, camera, {1, 1}, 0.5, 13.8)));
  EXPECT_EQ(point.depth.variance, 1e-4);
}

std::vector<Sighting> sightings_of(StateChance& chance, const Vector3d& p, int count, double baseline_m, double sigma) {
  std::vector<Sighting> out;
  for (int i = 0; i < count; ++i) {
    const Pose T{Exp(chance.vector(0.1)), Vector3d(baseline_m * i, chance.normal(0.01), 0)};
    const Vector3d exact = (T.inverse() * p).normalized();
    out.push_back({T, (exact + sigma * chance.vector(1)).normalized()});
  }
  return out;
}

TEST(EstimatorTriangulation, FindsThePointWithinItsCovariance) {
  StateChance chance(9);
  constexpr int kRuns = 300;
  constexpr double kSigma = 0.001;
  double nees = 0;
  int found = 0;
  for (int run = 0; run < kRuns; ++run) {
    const Vector3d p(chance.normal(1), chance.normal(1), chance.uniform(3, 8));
    Triangulation out;
    if (!triangulate(sightings_of(chance, p, 6, 0.1, kSigma), kSigma, 0.02, out)) continue;
    ++found;
    const Vector3d error = out.p_world_m - p;
    nees += error.dot(out.covariance_m2.ldlt().solve(error));
  }
  EXPECT_GT(found, 270);  // each of six rays within three sigma
  EXPECT_NEAR(nees / found, 3, 0.5);
}

TEST(EstimatorTriangulation, RefusesTooFewTooNearlyParallelAndContradicting) {
  StateChance chance(10);
  const Vector3d p(0.3, -0.2, 5);
  Triangulation out;
  EXPECT_FALSE(triangulate(sightings_of(chance, p, 2, 0.2, 0), 0.001, 0.02, out));
  EXPECT_FALSE(triangulate(sightings_of(chance, p, 5, 0.005, 0), 0.001, 0.02, out));
  EXPECT_FALSE(triangulate({}, 0.001, 0.02, out));
  auto moving = sightings_of(chance, p, 5, 0.1, 0);
  EXPECT_TRUE(triangulate(moving, 0.001, 0.02, out));
  moving[2].bearing = (moving[2].bearing + Vector3d(0, 0.01, 0)).normalized();
  EXPECT_FALSE(triangulate(moving, 0.001, 0.02, out));
  auto behind = sightings_of(chance, p, 5, 0.1, 0);
  for (Sighting& s : behind) s.bearing = -s.bearing;
  EXPECT_FALSE(triangulate(behind, 0.001, 0.02, out));
  behind[0].bearing.x() = NAN;
  EXPECT_FALSE(triangulate(behind, 0.001, 0.02, out));
}

}  // namespace
}  // namespace lxd::estimator_depth_filter_test
