// SPDX-License-Identifier: Apache-2.0
// The search for the place round about a vague prediction, on landscapes like those of a sweep in its map.
#include <Eigen/Core>
#include <gtest/gtest.h>

#include "estimator/place_search.hpp"

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
  const auto fit = [&](const PlaceOffset& at) { return std::max(peak(at, truth, 0.9), peak(at, alike, 0.65)); };
  const FoundPlace found = seek_place(6, kAsPredicted, fit);
  EXPECT_NEAR(found.offset.x_m, truth.x_m, 0.1);
  EXPECT_NEAR(found.offset.y_m, truth.y_m, 0.1);
  EXPECT_NEAR(found.offset.yaw_rad, truth.yaw_rad, 0.01);
}

// Given a body that has turned round; when one of the yaws that it may have is about right, then it is found.
TEST(PlaceSearch, EachYawIsTried) {
  const PlaceOffset truth{-2.4, 1.5, 1.55};
  const std::array<double, 2> yaws{0, 1.5};
  const FoundPlace found = seek_place(4, yaws, [&](const PlaceOffset& at) { return peak(at, truth, 0.9); });
  EXPECT_NEAR(found.offset.x_m, truth.x_m, 0.1);
  EXPECT_NEAR(found.offset.y_m, truth.y_m, 0.1);
  EXPECT_NEAR(found.offset.yaw_rad, truth.yaw_rad, 0.01);
}

// Given a fit of any shape, when a place is sought, then the work is bounded.
TEST(PlaceSearch, WorkIsBounded) {
  int asked = 0;
  const auto fit = [&](const PlaceOffset&) { return static_cast<double>(++asked); };  // each better than the last
  (void)seek_place(100, kAsPredicted, fit);
  EXPECT_LT(asked, 800);
}

}  // namespace
}  // namespace lxd::estimator_place_search_test
