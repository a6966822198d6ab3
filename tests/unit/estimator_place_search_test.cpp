// SPDX-License-Identifier: Apache-2.0
// The search for the place round about a vague prediction, on landscapes like those of a sweep in its map.
#include <string>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "estimator/place_search.hpp"
#include "estimator/place_trial.hpp"

namespace lxd::estimator_place_search_test {
namespace {

constexpr std::array<double, 1> kAsPredicted{0};

// As a sweep agrees with the map of a car park: a peak of some decimetres, slopes from metres away.
double peak(const PlaceOffset& at, const PlaceOffset& top, double height) {
  const double lever_m = 10;
  const double away_m =
      Eigen::Vector2d(at.x_m - top.x_m, at.y_m - top.y_m).norm() + lever_m * std::abs(at.yaw_rad - top.yaw_rad);
  return height * (0.5 / (1 + away_m / 0.3) + 0.5 / (1 + away_m / 6));
}

// Given a body that went on for four metres while nobody looked, and a bay nearer to the prediction that looks alike;
// when its place is sought, then the true one is found, not the nearer.
TEST(PlaceSearch, ABetterPlaceFartherAwayIsFound) {
  const PlaceOffset truth{3.8, -0.6, 0.07}, alike{1.1, 0.1, 0};
  const auto fit = [&](const PlaceOffset& at, FitDetail) {
    return std::max(peak(at, truth, 0.9), peak(at, alike, 0.65));
  };
  const FoundPlace found = seek_place(6, kAsPredicted, fit);
  EXPECT_NEAR(found.offset.x_m, truth.x_m, 0.1);
  EXPECT_NEAR(found.offset.y_m, truth.y_m, 0.1);
  EXPECT_NEAR(found.offset.yaw_rad, truth.yaw_rad, 0.01);
}

// Given a body that has turned round; when one of the yaws that it may have is about right, then it is found.
TEST(PlaceSearch, EachYawIsTried) {
  const PlaceOffset truth{-2.4, 1.5, 1.55};
  const std::array<double, 2> yaws{0, 1.5};
  const FoundPlace found = seek_place(4, yaws, [&](const PlaceOffset& at, FitDetail) { return peak(at, truth, 0.9); });
  EXPECT_NEAR(found.offset.x_m, truth.x_m, 0.1);
  EXPECT_NEAR(found.offset.y_m, truth.y_m, 0.1);
  EXPECT_NEAR(found.offset.yaw_rad, truth.yaw_rad, 0.01);
}

// Given a coarse fit that prefers the wrong one of two bays that look alike; when the fine fit does not, then the right
// one is found.
TEST(PlaceSearch, WhatIsCoarseDoesNotDecide) {
  const PlaceOffset truth{3.8, -0.9, 0.01}, alike{-2.1, 0.1, 0};
  const auto fit = [&](const PlaceOffset& at, FitDetail detail) {
    return std::max(peak(at, truth, 0.7), peak(at, alike, detail == FitDetail::fine ? 0.5 : 0.75));
  };
  EXPECT_NEAR(seek_place(6, kAsPredicted, fit).offset.x_m, truth.x_m, 0.1);
}

// Given a place whose fit is a narrow peak without slopes, between lesser ones that are broad; then it is found, though
// the images gave a second yaw that is as good as the predicted one.
TEST(PlaceSearch, ANarrowPeakIsFound) {
  const std::array<double, 2> yaws{0, 0.01};
  for (const PlaceOffset& truth :
       {PlaceOffset{3.7, -0.3, 0.02}, PlaceOffset{-4.25, 2.25, 0}, PlaceOffset{0.2, 5.3, 0}}) {
    const auto fit = [&](const PlaceOffset& at, FitDetail) {
      const double away_m = std::hypot(at.x_m - truth.x_m, at.y_m - truth.y_m);
      return std::max(
          {0.7 - away_m, peak(at, {1, 0, 0}, 0.42), peak(at, {-1, -2, 0}, 0.42), peak(at, {2, 3, 0}, 0.42)});
    };
    EXPECT_NEAR(seek_place(6, yaws, fit).offset.x_m, truth.x_m, 0.1);
    EXPECT_NEAR(seek_place(6, yaws, fit).offset.y_m, truth.y_m, 0.1);
  }
}

// Given a fit of any shape and more yaws than are looked at, when a place is sought, then the work is bounded, and of
// what costs most there is least.
TEST(PlaceSearch, WorkIsBounded) {
  const std::array<double, 3> yaws{0, 1, 2};
  int coarse = 0, fine = 0;
  const auto fit = [&](const PlaceOffset&, FitDetail detail) {  // each better than the last
    ++(detail == FitDetail::fine ? fine : coarse);
    return static_cast<double>(coarse + fine);
  };
  (void)seek_place(100, yaws, fit);
  EXPECT_LE(coarse, kCoarseFitsMax);
  EXPECT_LE(fine, kFineFitsMax);
  EXPECT_LT(kFineFitsMax, 100);
  EXPECT_LT(kCoarseFitsMax, 520);
}

// Given a body that is sought in vain; then the searches become rare, but there are several in the first two seconds;
// and once it is found, the next silence begins with one.
TEST(PlaceSearch, RestsWhenItDoesNotHelp) {
  constexpr int kTwoSeconds = 20;  // sweeps
  SearchRest rest;
  std::string made;
  for (int sweep = 0; sweep < kTwoSeconds; ++sweep) made += rest.may_seek() ? 'x' : '.';
  EXPECT_EQ(made, "x.x..x....x....x....");
  rest.found();
  EXPECT_TRUE(rest.may_seek());
}

// Given a place that was found after a silence; then it is on trial until some sweeps in a row have held, and one that
// does not begins it anew.
TEST(PlaceTrial, EndsWhenSweepsInARowHaveHeld) {
  PlaceTrial trial;
  EXPECT_FALSE(trial.open());
  trial.begin();
  EXPECT_FALSE(trial.failed());  // nothing had held that would have to be forgotten
  for (std::uint32_t i = 0; i + 1 < PlaceTrial::kSweeps; ++i) trial.held();
  EXPECT_TRUE(trial.open());
  EXPECT_TRUE(trial.failed());
  for (std::uint32_t i = 0; i < PlaceTrial::kSweeps; ++i) {
    EXPECT_TRUE(trial.open());
    trial.held();
  }
  EXPECT_FALSE(trial.open());
}

}  // namespace
}  // namespace lxd::estimator_place_search_test
