// SPDX-License-Identifier: Apache-2.0
// Wheels that are stamped late: the way that they rolled is held against the LiDAR's, and says by how much.
#include <cmath>

#include <gtest/gtest.h>

#include "estimator/wheel_alignment.hpp"
#include "rt/so3.hpp"
#include "tests/support/mapping_scene.hpp"

namespace lxd::estimator_wheel_alignment_test {
namespace {

using Eigen::Vector3d;

constexpr double kReading_s = 0.02;

RigTime at(double t_s) { return RigTime::from_seconds(t_s); }

// A cart that speeds up and slows down on a winding way, and where it has come to.
double speed(double t) { return 1 + 0.6 * std::sin(1.3 * t); }
double way(double t) { return t - 0.6 / 1.3 * std::cos(1.3 * t); }
double rate(double t) { return 0.4 * std::sin(1.7 * t); }
double heading(double t) { return -0.4 / 1.7 * std::cos(1.7 * t); }

struct Cart {
  explicit Cart(double late_s, double scale = 1) {
    for (double t = 0; t < 40; t += kReading_s) history.add({at(t + late_s), scale * speed(t), rate(t)});
  }
  test::OwnedArena arena{std::size_t{1} << 17};
  WheelHistory history{*arena};
};

// What the alignment finds of the last 15 s, which the ring holds.
WheelAlignment found(Cart& cart, WheelAlignment alignment) {
  for (double t = 21; t < 39; t += 0.5) {
    cart.history.set_delay(alignment.delay());
    const auto rolled = cart.history.way(at(t), at(t + 0.5));
    if (rolled) alignment.compare({way(t + 0.5) - way(t), heading(t + 0.5) - heading(t)}, *rolled, rolled->span_s);
  }
  return alignment;
}

TEST(WheelAlignment, AnArcsWayIsThatOfItsCircle) {
  for (const double radius_m : {0.5, 3.0, -8.0, 1e7}) {
    const double way_m = 0.4, turn = way_m / radius_m;
    const Pose then{Exp(Vector3d(0.1, -0.2, 2)), {3, 4, 5}};
    const Pose moved{Exp(Vector3d(0, 0, turn)), {radius_m * std::sin(turn), radius_m * (1 - std::cos(turn)), 0}};
    const DrivenArc arc = driven_arc(then, then * moved);
    EXPECT_NEAR(arc.way_m, way_m, 1e-6) << radius_m;
    EXPECT_NEAR(arc.turn_rad, turn, 1e-9);
    EXPECT_NEAR(driven_arc(then * moved, then).way_m, -way_m, 1e-6);
  }
}

// The derivative by the delay that compare() takes: the way grows by the change of speed for each second of it.
TEST(WheelAlignment, TheWaysDerivativeByTheDelayIsTheChangeOfSpeed) {
  constexpr double kStep_s = 1e-4;
  Cart cart(0);
  for (const double t : {21.013, 24.5, 29.991}) {
    const auto rolled = [&](double delay_s) {
      cart.history.set_delay(Duration::from_seconds(delay_s));
      return *cart.history.way(at(t), at(t + 0.505));
    };
    const WheelWay middle = rolled(0), more = rolled(kStep_s), less = rolled(-kStep_s);
    // Between readings speeds are interpolated linearly: the way is a parabola there, and the difference exact.
    EXPECT_NEAR((more.way_m - less.way_m) / (2 * kStep_s), middle.speed_change_mps, 1e-6) << t;
    EXPECT_NEAR((more.turn_rad - less.turn_rad) / (2 * kStep_s), middle.rate_change_radps, 1e-6) << t;
    EXPECT_NEAR(middle.span_s, 0.505, 1e-9);
    EXPECT_NEAR(middle.way_m, way(t + 0.505) - way(t), 1e-4);
  }
}

TEST(WheelAlignment, LateWheelsAreFoundOut) {
  for (const double late_s : {0.0, 0.02, -0.015}) {
    Cart cart(late_s), worn(late_s, 0.99);
    for (Cart* const of : {&cart, &worn}) {
      const WheelAlignment alignment = found(*of, WheelAlignment(0, 0.02, 0.02, 0.02));
      EXPECT_NEAR(alignment.delay_s(), late_s, 0.002);
      EXPECT_LT(alignment.delay_sigma_s(), 0.005);
      EXPECT_GT(alignment.delay_sigma_s(), 2e-4);
    }
  }
}

TEST(WheelAlignment, WhoGoesOnSteadilyTellsNothing) {
  WheelAlignment alignment(0, 0.02, 0.02, 0.02);
  for (int i = 0; i < 100; ++i) alignment.compare({0.52, 0.21}, {0.5, 0.2, 0.001, 0, 0.5, 25}, 0.5);
  EXPECT_EQ(alignment.delay_s(), 0);
  EXPECT_GE(alignment.delay_sigma_s(), 0.02);
}

TEST(WheelAlignment, SlipIsNotTakenForIt) {
  WheelAlignment alignment(0, 0.02, 0.02, 0.02);
  for (int i = 0; i < 20; ++i) alignment.compare({0.2, 0}, {0.9, 0, 0.3, 0, 0.5, 25}, 0.5);
  EXPECT_NEAR(alignment.delay_s(), 0, 0.02);
}

TEST(WheelAlignment, WhatTheRigFileSaysExactlyIsBelieved) {
  Cart cart(0.02);
  const WheelAlignment alignment = found(cart, WheelAlignment(0.004, 0, 0.02, 0.02));
  EXPECT_TRUE(alignment.known());
  EXPECT_EQ(alignment.delay_s(), 0.004);
}

TEST(WheelAlignment, ReadingsThatDoNotReachSoFarOrHaveAHoleTellNoWay) {
  test::OwnedArena arena(std::size_t{1} << 17);
  WheelHistory history(*arena);
  EXPECT_FALSE(history.way(at(1), at(2)));
  for (const double t : {1.0, 1.1, 1.2, 1.5, 1.6}) history.add({at(t), 1, 0});
  EXPECT_TRUE(history.way(at(1.05), at(1.15)));
  EXPECT_FALSE(history.way(at(0.9), at(1.1)));
  EXPECT_FALSE(history.way(at(1.1), at(1.55)));
  EXPECT_FALSE(history.way(at(1.55), at(1.65)));
  EXPECT_FALSE(history.way(at(1.15), at(1.1)));
  history.set_delay(Duration::from_seconds(0.5));
  EXPECT_TRUE(history.way(at(0.55), at(0.65)));
}

}  // namespace
}  // namespace lxd::estimator_wheel_alignment_test
