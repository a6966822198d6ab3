// SPDX-License-Identifier: Apache-2.0
// Every carrier along ways that it would take: at rest, in motion, within what it can do, and where it should be.
#include <cmath>
#include <numbers>
#include <ostream>

#include <gtest/gtest.h>

#include "tests/support/motion_checks.hpp"
#include "tests/support/motion_routes.hpp"
#include "tools/simulator/motion/make_motion.hpp"
#include "tools/simulator/random.hpp"

namespace lxd::sim::simulator_carriers_test {
namespace {

using Eigen::Vector3d;

constexpr double kDegree = std::numbers::pi / 180;
constexpr double kDuration_s = 40;

struct Case {
  const char* carrier;
  const char* route;
  double height_m;
  // At most, anywhere: m/s, m/s^2, rad/s, rad of tilt against the vertical.
  double speed, acceleration, rate, tilt;
  friend std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.carrier << " " << c.route; }
};

Trajectory motion_of(const Case& c, bool moving, std::uint64_t seed = 1, double duration_s = kDuration_s) {
  MotionConfig config;
  config.carrier = c.carrier;
  config.route = c.route;
  config.start_moving = moving;
  auto motion = make_motion(config, test::world_of_ways(), seed, duration_s);
  EXPECT_TRUE(motion.ok()) << (motion.ok() ? "" : motion.error().message);
  return motion.ok() ? *motion : Trajectory(0, 1, {}, {});
}

const Route& route_named(const World& world, std::string_view name) {
  return *std::ranges::find(world.routes, name, &Route::name);
}

double sideways(const MotionState& state) { return (state.T_world_body.R.transpose() * state.v_world_mps).y(); }
double tilt(const Pose& pose) { return std::acos(std::min(1.0, pose.R(2, 2))); }

class SimulatorCarriers : public ::testing::TestWithParam<Case> {};

TEST_P(SimulatorCarriers, StandsStillExactlyThenMoves) {
  const Trajectory motion = motion_of(GetParam(), false);
  ASSERT_LE(motion.begin_s(), -1);
  ASSERT_GE(motion.end_s(), kDuration_s + 1);
  const Pose start = motion.pose(0);
  for (double t = -1; t <= 2; t += 0.0137) {
    const MotionState state = motion.at(t);
    EXPECT_EQ(state.T_world_body.p, start.p) << t;
    EXPECT_EQ(state.v_world_mps.norm() + state.a_world_mps2.norm(), 0) << t;
    EXPECT_EQ(state.omega_body_radps.norm() + state.alpha_body_radps2.norm(), 0) << t;
  }
  EXPECT_LT(tilt(start), GetParam().tilt);
  EXPECT_GT((motion.pose(6).p - start.p).norm(), 0.5);
}

TEST_P(SimulatorCarriers, MovesFromTheFirstInstantOnRequest) {
  const Trajectory motion = motion_of(GetParam(), true);
  for (double t = -1; t <= 1; t += 0.25) EXPECT_GT(motion.at(t).v_world_mps.norm(), 0.3) << t;
}

TEST_P(SimulatorCarriers, StaysWithinWhatItCanDo) {
  const Trajectory motion = motion_of(GetParam(), false);
  double way_m = 0;
  for (double t = 0; t < kDuration_s; t += 0.003) {
    const MotionState state = motion.at(t);
    way_m += 0.003 * state.v_world_mps.norm();
    ASSERT_LT(state.v_world_mps.norm(), GetParam().speed) << t;
    ASSERT_LT(state.a_world_mps2.norm(), GetParam().acceleration) << t;
    ASSERT_LT(state.omega_body_radps.norm(), GetParam().rate) << t;
    ASSERT_LT(tilt(state.T_world_body), GetParam().tilt) << t;
  }
  EXPECT_GT(way_m, 10);
}

TEST_P(SimulatorCarriers, KeepsClearOfWhatIsBesideTheRoute) {
  const World world = test::world_of_ways();
  const Route& route = route_named(world, GetParam().route);
  const Trajectory motion = motion_of(GetParam(), false);
  for (double t = 0; t < kDuration_s; t += 0.02) {
    const Vector3d p = motion.pose(t).p;
    ASSERT_LT(test::off_route_m(route, p), route.clearance_m) << t;
  }
  EXPECT_NEAR(motion.pose(0).p.z(), route.way_m[0].z() + GetParam().height_m, 0.1);
}

TEST_P(SimulatorCarriers, IntegratedSamplesComeOutWhereItIs) {
  for (const bool moving : {false, true}) {
    const Trajectory motion = motion_of(GetParam(), moving);
    for (const double begin_s : {0.0, 20.0}) {
      const test::ReckoningError error = test::reckon(motion, begin_s, 10, 0.005);
      EXPECT_LT(error.position_m, 0.001) << begin_s;
      EXPECT_LT(error.angle_rad, 0.01 * kDegree) << begin_s;
    }
  }
}

TEST_P(SimulatorCarriers, SeedsAreMotionsOfTheirOwn) {
  const Trajectory one = motion_of(GetParam(), true, 1, 5), same = motion_of(GetParam(), true, 1, 5);
  const Trajectory other = motion_of(GetParam(), true, 2, 5);
  EXPECT_EQ(one.pose(4.321).p, same.pose(4.321).p);
  EXPECT_EQ(one.pose(4.321).R, same.pose(4.321).R);
  EXPECT_GT((one.pose(4.321).R - other.pose(4.321).R).norm(), 1e-5);
}

constexpr double kAnyTurn = 6;
INSTANTIATE_TEST_SUITE_P(All, SimulatorCarriers,
                         ::testing::Values(Case{"handheld", "walk", 1.45, 1.8, 6, 3, 25 * kDegree},
                                           Case{"handheld", "stairs", 1.45, 1.8, 6, 3, 25 * kDegree},
                                           Case{"uav", "fly", 0, 6, 9, kAnyTurn, 45 * kDegree},
                                           Case{"legged", "walk", 0.5, 1.2, 18, 3, 8 * kDegree},
                                           Case{"wheeled", "yard", 0.3, 1.05, 1.2, 1.2, 1 * kDegree},
                                           Case{"wheeled", "drive", 0.3, 1.05, 1.2, 1.2, 5 * kDegree},
                                           Case{"car", "drive", 0.9, 8.1, 3, 0.7, 6 * kDegree}),
                         [](const auto& test) { return std::string(test.param.carrier) + "_" + test.param.route; });

TEST(SimulatorWheeledCarriers, NeverMoveSideways) {
  for (const auto& [carrier, route] : {std::pair{"wheeled", "walk"}, std::pair{"wheeled", "yard"},
                                       std::pair{"wheeled", "drive"}, std::pair{"car", "drive"}}) {
    const Trajectory motion = motion_of({carrier, route, 0, 0, 0, 0, 0}, false);
    for (double t = 0; t < kDuration_s; t += 0.0017) ASSERT_LT(std::abs(sideways(motion.at(t))), 1e-6) << carrier << t;
  }
}

TEST(SimulatorWheeledCarriers, CarLeansOutOfBendsThatItsTyresHold) {
  const Trajectory motion = motion_of({"car", "drive", 0, 0, 0, 0, 0}, false, 1, 120);
  double hardest = 0;
  for (double t = 0; t < 120; t += 0.01) {
    const MotionState state = motion.at(t);
    const double across = (state.T_world_body.R.transpose() * state.a_world_mps2).y();
    hardest = std::max(hardest, std::abs(across));
    const double roll = std::asin(state.T_world_body.R(2, 1));
    if (std::abs(across) > 1.5) {
      EXPECT_GT(roll * across, 0) << t;
    }
  }
  EXPECT_LT(hardest, 2.5);
  EXPECT_GT(hardest, 1.5);
}

TEST(SimulatorWheeledCarriers, CarStaysAtTheEndOfItsRoute) {
  const Trajectory motion = motion_of({"car", "lane", 0, 0, 0, 0, 0}, false);
  EXPECT_LT((motion.pose(kDuration_s).p - Vector3d(70, 5, 0.9)).norm(), 0.01);
  EXPECT_LT(motion.at(kDuration_s).v_world_mps.norm(), 1e-9);
}

TEST(SimulatorCarrierRoutes, OpenOnesAreWalkedBackAndClosedOnesRoundAndRound) {
  const Trajectory back = motion_of({"wheeled", "walk", 0, 0, 0, 0, 0}, false, 1, 90);
  double furthest = 0, furthest_s = 0;
  for (double t = 0; t < 40; t += 0.1)
    if (const double y = back.pose(t).p.y(); y > furthest) furthest = y, furthest_s = t;
  EXPECT_NEAR(furthest, 8, 0.01);
  double nearest = 1e9;
  for (double t = furthest_s; t < 90; t += 0.1) nearest = std::min(nearest, back.pose(t).p.norm());
  EXPECT_LT(nearest, 0.35);

  const Trajectory round = motion_of({"wheeled", "yard", 0, 0, 0, 0, 0}, false, 1, 160);
  double way_m = 0, slowest = 1e9;
  for (double t = 6; t < 160; t += 0.1) {
    slowest = std::min(slowest, round.at(t).v_world_mps.norm());
    way_m += 0.1 * round.at(t).v_world_mps.norm();
  }
  EXPECT_GT(way_m, 64);     // once round
  EXPECT_GT(slowest, 0.1);  // through the start without a stop
}

TEST(SimulatorCarrierRoutes, UavTiltsIntoItsAcceleration) {
  const Trajectory motion = motion_of({"uav", "fly", 0, 0, 0, 0, 0}, false);
  double largest = 0;
  for (double t = 5; t < kDuration_s; t += 0.05) {
    const MotionState state = motion.at(t);
    const Vector3d thrust = state.a_world_mps2 + Vector3d(0, 0, 9.80665);
    const double off = std::acos(std::min(1.0, thrust.normalized().dot(state.T_world_body.R.col(2))));
    EXPECT_LT(off, 3 * kDegree) << t;
    largest = std::max(largest, tilt(state.T_world_body));
  }
  EXPECT_GT(largest, 20 * kDegree);
}

// Ways as nobody would lay them: what is not refused is kept to.
TEST(SimulatorCarrierRoutes, AnyAcceptedOneIsFollowedWithinItsClearance) {
  int accepted = 0;
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    Random random(seed, "routes");
    Route route{"walk", {Vector3d::Zero()}, random.chance(0.5), random.uniform(0.3, 2)};
    for (int i = 0; i < 4; ++i)
      route.way_m.emplace_back(random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-0.5, 0.5));
    World world;
    world.routes = {route};
    for (const char* carrier : {"handheld", "wheeled"}) {
      MotionConfig config;
      config.carrier = carrier;
      config.route = "walk";
      config.rest_s = random.uniform(0, 3);
      const auto motion = make_motion(config, world, seed, 10);
      if (!motion) continue;
      ++accepted;
      for (double t = 0; t < 10; t += 0.02) {
        const MotionState state = motion->at(t);
        ASSERT_LT(test::off_route_m(route, state.T_world_body.p), route.clearance_m) << seed << " " << t;
        ASSERT_LT(state.omega_body_radps.norm(), 3) << seed << " " << t;
        if (t <= config.rest_s) {
          ASSERT_EQ(state.omega_body_radps.norm(), 0) << seed << " " << t;
        }
        if (config.carrier == "wheeled") {
          ASSERT_LT(std::abs(sideways(state)), 1e-6) << seed << " " << t;
        }
      }
    }
  }
  EXPECT_GT(accepted, 4);
}

}  // namespace
}  // namespace lxd::sim::simulator_carriers_test
