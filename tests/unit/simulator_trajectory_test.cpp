// SPDX-License-Identifier: Apache-2.0
// The motion's curve: its derivatives against difference quotients, its smoothness at knots, its ends, and that its
// samples, integrated, come out where it does.
#include <cmath>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "rt/so3.hpp"
#include "tests/support/motion_checks.hpp"
#include "tools/simulator/motion/trajectory.hpp"
#include "tools/simulator/random.hpp"

namespace lxd::sim::simulator_trajectory_test {
namespace {

using Eigen::Quaterniond;
using Eigen::Vector3d;

// Rough on purpose: neighbours up to a metre and a radian apart.
Trajectory random_motion(std::uint64_t seed, std::size_t count, double step_s) {
  Random random(seed, "trajectory_test");
  const auto vector = [&] { return Vector3d(random.normal(), random.normal(), random.normal()); };
  std::vector<Vector3d> positions;
  std::vector<Quaterniond> rotations;
  Quaterniond R(Exp(vector()));
  for (std::size_t i = 0; i < count; ++i) {
    positions.push_back(vector());
    rotations.push_back(i % 3 == 0 ? Quaterniond(-R.coeffs()) : R);  // both signs are the same rotation
    R = R * Quaterniond(Exp(0.4 * vector()));
  }
  return {-1, step_s, positions, rotations};
}

// A walk with a hand's shake, up to 12 degrees and 4 cm at some Hz, as control points 20 ms apart.
Trajectory shaken_walk() {
  constexpr double kStep = 0.02;
  std::vector<Vector3d> positions;
  std::vector<Quaterniond> rotations;
  for (int i = 0; i < 700; ++i) {
    const double t = kStep * i;
    const double gait = 2 * std::numbers::pi * 2.0 * t;
    positions.emplace_back(1.2 * t, 0.04 * std::sin(gait / 2), 0.03 * std::sin(gait));
    const Vector3d shake(0.1 * std::sin(1.7 * gait), 0.2 * std::sin(gait + 1), 0.5 * std::sin(0.3 * gait));
    rotations.emplace_back(Exp(shake));
  }
  return {-1, kStep, positions, rotations};
}

TEST(SimulatorTrajectory, DerivativesAreThoseOfThePoses) {
  const Trajectory motion = random_motion(1, 60, 0.5);
  Random random(2, "times");
  for (int i = 0; i < 500; ++i) {
    const double t = random.uniform(motion.begin_s() + 0.01, motion.end_s() - 0.01);
    const MotionState state = motion.at(t);
    const test::Differences expected(motion, t);
    EXPECT_LT((state.v_world_mps - expected.v).norm(), 1e-5) << t;
    EXPECT_LT((state.a_world_mps2 - expected.a).norm(), 1e-5) << t;
    EXPECT_LT((state.omega_body_radps - expected.omega).norm(), 1e-5) << t;
    EXPECT_LT((state.alpha_body_radps2 - expected.alpha).norm(), 1e-5) << t;
  }
}

TEST(SimulatorTrajectory, PoseIsThatOfTheState) {
  const Trajectory motion = random_motion(3, 20, 0.1);
  for (double t = motion.begin_s() - 1; t < motion.end_s() + 1; t += 0.0171) {
    const Pose pose = motion.pose(t);
    const Pose state = motion.at(t).T_world_body;
    EXPECT_LT((pose.p - state.p).norm(), 1e-13);
    EXPECT_LT((pose.R - state.R).norm(), 1e-13);
    EXPECT_LT((pose.R.transpose() * pose.R - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  }
}

TEST(SimulatorTrajectory, KnotsCannotBeSeen) {
  const Trajectory motion = random_motion(4, 30, 0.25);
  constexpr double kBeside = 1e-9;
  for (double knot = motion.begin_s() + 0.25; knot < motion.end_s() - 0.1; knot += 0.25) {
    const MotionState before = motion.at(knot - kBeside), after = motion.at(knot + kBeside);
    EXPECT_LT((before.T_world_body.p - after.T_world_body.p).norm(), 1e-7);
    EXPECT_LT((before.a_world_mps2 - after.a_world_mps2).norm(), 1e-4) << knot;
    EXPECT_LT((before.alpha_body_radps2 - after.alpha_body_radps2).norm(), 1e-4) << knot;
  }
}

TEST(SimulatorTrajectory, EndsAreHeldAtRest) {
  const Trajectory motion = random_motion(5, 10, 0.1);
  for (const auto& [end, outside] : {std::pair{motion.begin_s(), -5.0}, std::pair{motion.end_s(), 5.0}}) {
    const MotionState state = motion.at(end + outside);
    EXPECT_LT((state.T_world_body.p - motion.pose(end).p).norm(), 1e-12);
    EXPECT_LT((state.T_world_body.R - motion.pose(end).R).norm(), 1e-12);
    EXPECT_EQ(state.v_world_mps.norm() + state.a_world_mps2.norm(), 0);
    EXPECT_EQ(state.omega_body_radps.norm() + state.alpha_body_radps2.norm(), 0);
  }
}

TEST(SimulatorTrajectory, TimesAreThoseOfTheControlPoints) {
  std::vector<Vector3d> line;
  for (int i = 0; i < 12; ++i) line.emplace_back(i, 2 * i, -i);
  const Trajectory motion(10, 0.5, line, std::vector<Quaterniond>(12, Quaterniond::Identity()));
  EXPECT_DOUBLE_EQ(motion.begin_s(), 11);
  EXPECT_DOUBLE_EQ(motion.end_s(), 14.5);
  EXPECT_LT((motion.pose(12.25).p - 4.5 * Vector3d(1, 2, -1)).norm(), 1e-12);
  EXPECT_LT((motion.at(12.25).v_world_mps - 2 * Vector3d(1, 2, -1)).norm(), 1e-12);
}

TEST(SimulatorTrajectory, FewControlPointsStandStill) {
  const Trajectory none(0, 0.1, {}, {});
  EXPECT_EQ(none.pose(0.3).p.norm(), 0);
  const Trajectory one(0, 0.1, {Vector3d(1, 2, 3)}, {Quaterniond(Exp(Vector3d(0, 0, 1)))});
  EXPECT_LT((one.pose(0.25).p - Vector3d(1, 2, 3)).norm(), 1e-12);
  EXPECT_NEAR(Log(one.pose(7).R).z(), 1, 1e-12);
}

TEST(SimulatorTrajectory, IntegratedSamplesComeOutWhereItDoes) {
  const test::ReckoningError error = test::reckon(shaken_walk(), 0.5, 10, 0.005);
  EXPECT_LT(error.position_m, 0.001);
  EXPECT_LT(error.angle_rad, 0.01 * std::numbers::pi / 180);
}

// An error of the samples that is one of the formulas and not of the step does not go away with it.
TEST(SimulatorTrajectory, IntegrationConvergesWithTheStep) {
  const Trajectory motion = shaken_walk();
  const test::ReckoningError coarse = test::reckon(motion, 0.5, 10, 0.005);
  const test::ReckoningError fine = test::reckon(motion, 0.5, 10, 0.00125);
  EXPECT_LT(fine.position_m, coarse.position_m / 8);
  EXPECT_LT(fine.angle_rad, coarse.angle_rad / 8);
}

}  // namespace
}  // namespace lxd::sim::simulator_trajectory_test
