// SPDX-License-Identifier: Apache-2.0
// Bidirectional PnP: its derivatives, its pose under noise and wrong matches, its covariance, and what it refuses.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "backend/pnp/bidirectional_pnp.hpp"
#include "tests/support/sight_scene.hpp"

namespace lxd::backend_pnp_test {
namespace {

Vector6d difference(const Pose& truth, const Pose& found) {
  Vector6d out;
  out.head<3>() = Log(truth.R.transpose() * found.R);
  out.tail<3>() = found.p - truth.p;
  return out;
}

TEST(BidirectionalPnp, DerivativesAgreeWithDifferences) {
  const Pose T{Exp({0.2, -0.4, 0.3}), {0.5, -0.3, 0.8}};
  ProjectionConstraint constraint;
  constraint.point_m = {0.7, -0.4, 6};
  constraint.seen = {0.1, 0.05};
  constraint.seen_sigma = 1;  // no whitening by the point, which is not differentiated
  for (const Direction direction : {Direction::forward, Direction::backward}) {
    constraint.direction = direction;
    ProjectionResidual at;
    ASSERT_TRUE(project_constraint(constraint, T, at));
    constexpr double kStep = 1e-6;
    for (int i = 0; i < 6; ++i) {
      const Vector6d d = kStep * Vector6d::Unit(i);
      ProjectionResidual plus, minus;
      ASSERT_TRUE(project_constraint(constraint, {T.R * Exp(d.head<3>()), T.p + d.tail<3>()}, plus));
      ASSERT_TRUE(project_constraint(constraint, {T.R * Exp(-d.head<3>()), T.p - d.tail<3>()}, minus));
      EXPECT_LT(((plus.r - minus.r) / (2 * kStep) - at.J.col(i)).norm(), 1e-7) << i;
    }
  }
}

TEST(BidirectionalPnp, APointBehindTheCameraIsNoConstraint) {
  ProjectionConstraint constraint;
  constraint.point_m = {0, 0, -5};
  constraint.seen_sigma = 1;
  ProjectionResidual out;
  EXPECT_FALSE(project_constraint(constraint, {}, out));
}

TEST(BidirectionalPnp, MeasuresTheLoopBetweenTheBodies) {
  for (unsigned seed = 1; seed < 6; ++seed) {
    const test::SightScene scene({.turn_rad = 0.6}, seed);
    const auto loop = visual_loop(scene.historical, scene.current, {});
    ASSERT_TRUE(loop) << seed;
    EXPECT_EQ(loop->from, 3);
    EXPECT_EQ(loop->to, 9);
    const Vector6d error = difference(scene.T_from_to(), loop->T_from_to);
    EXPECT_LT(error.head<3>().norm(), 0.02) << seed;
    EXPECT_LT(error.tail<3>().norm(), 0.2) << seed;
  }
}

TEST(BidirectionalPnp, SaysTheSameTwice) {
  const test::SightScene scene({}, 1);
  const auto one = visual_loop(scene.historical, scene.current, {}),
             two = visual_loop(scene.historical, scene.current, {});
  ASSERT_TRUE(one && two);
  EXPECT_EQ(one->T_from_to.p, two->T_from_to.p);
  EXPECT_EQ(one->covariance, two->covariance);
}

// Mean of the normalised squared error of six dimensions: neither boasting nor far too modest.
TEST(BidirectionalPnp, CovarianceIsOfTheErrorsSize) {
  double sum = 0;
  int found = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const test::SightScene scene({.turn_rad = 0.4}, seed);
    const auto loop = visual_loop(scene.historical, scene.current, {});
    if (!loop) continue;
    const Vector6d error = difference(scene.T_from_to(), loop->T_from_to);
    sum += error.dot(loop->covariance.ldlt().solve(error));
    ++found;
  }
  ASSERT_GE(found, 55);
  EXPECT_LT(sum / found, 8);
  EXPECT_GT(sum / found, 1.5);
}

struct Tally {
  int found = 0;
  double error_m = 0;
};

Tally tally(test::SightConfig scene_config, bool backward) {
  Tally out;
  PnpConfig config;
  config.backward = backward;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const test::SightScene scene(scene_config, seed);
    const auto loop = visual_loop(scene.historical, scene.current, config);
    const Vector6d error = loop ? difference(scene.T_from_to(), loop->T_from_to) : Vector6d::Constant(1e3);
    if (error.tail<3>().norm() > 0.5) continue;
    ++out.found;
    out.error_m += error.tail<3>().norm();
  }
  return out;
}

TEST(BidirectionalPnp, IsNotWorseThanForwardOnlyAndBetterWhereOldLandmarksAreFew) {
  for (const double turn_rad : {0.2, 0.8}) {
    const test::SightConfig scene{.turn_rad = turn_rad};
    EXPECT_GE(tally(scene, true).found, tally(scene, false).found) << turn_rad;
  }
  const test::SightConfig few{.turn_rad = 0.6, .points = 90, .historical_points = 0.35};
  EXPECT_GT(tally(few, true).found, tally(few, false).found + 5);
}

TEST(BidirectionalPnp, UnrelatedViewsAreRefused) {
  for (unsigned seed = 1; seed < 10; ++seed) {
    const test::SightScene here({}, seed), elsewhere({}, seed + 100);
    EXPECT_FALSE(visual_loop(here.historical, elsewhere.current, {})) << seed;
  }
}

TEST(BidirectionalPnp, WrongMatchesOfAnotherPlaceAreRefused) {
  // Given matches at random between two clouds, as descriptors of repeated texture would give
  const test::SightScene here({}, 1), elsewhere({}, 2);
  std::vector<FeatureMatch> matches;
  const std::size_t count = std::min(here.historical.features.size(), elsewhere.current.features.size());
  for (std::uint32_t i = 0; i < count; ++i) matches.push_back({i, i});
  ASSERT_GT(count, 80U);
  EXPECT_EQ(solve_pnp(here.historical, elsewhere.current, matches, {}).verdict, PnpVerdict::few_inliers);
}

TEST(BidirectionalPnp, NothingInNothingOut) {
  EXPECT_FALSE(visual_loop({}, {}, {}));
  const test::SightScene scene({.historical_points = 0, .current_points = 0}, 1);
  EXPECT_FALSE(visual_loop(scene.historical, scene.current, {}));
}

TEST(FeatureMatch, OnlyClearAndMutualOnesAreTaken) {
  VisualFeature a, b, c;
  b.descriptor.fill(0xFF);
  c.descriptor.fill(0x0F);
  const std::vector<VisualFeature> historical = {a, b}, current = {b, a, c};
  const auto matches = match_features(historical, current, {});
  ASSERT_EQ(matches.size(), 2U);
  EXPECT_EQ(matches[0].current, 1U);
  EXPECT_EQ(matches[1].current, 0U);
  // Two that look the same are neither
  EXPECT_TRUE(match_features(historical, std::vector<VisualFeature>{a, a}, {}).empty());
  EXPECT_EQ(hamming(a.descriptor, c.descriptor), 128);
}

}  // namespace
}  // namespace lxd::backend_pnp_test
