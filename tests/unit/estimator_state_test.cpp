// SPDX-License-Identifier: Apache-2.0
// The state's manifold: [+] and [-] undo each other, keep the group, and differentiate as claimed.
#include <numbers>

#include <gtest/gtest.h>

#include "estimator/state.hpp"
#include "tests/support/estimator_states.hpp"
#include "tests/support/property.hpp"

namespace lxd::estimator_state_test {
namespace {

using test::check_property;
using test::StateChance;

// A random error state whose rotation is shorter than half a turn: only there does [-] give back what [+] was given.
StateVector error_state(StateChance& chance, double turn_max_rad) {
  StateVector dx;
  for (int i = 0; i < kStateDim; ++i) dx[i] = chance.normal(3);
  dx.segment<3>(kTheta) = chance.uniform(0, turn_max_rad) * chance.direction();
  return dx;
}

StateChance any_chance() { return StateChance(*rc::gen::arbitrary<unsigned>()); }

TEST(EstimatorState, BoxminusGivesBackWhatBoxplusAdded) {
  check_property([] {
    StateChance chance = any_chance();
    const State x = chance.state();
    const StateVector dx = error_state(chance, std::numbers::pi - 1e-6);
    RC_ASSERT((boxminus(boxplus(x, dx), x) - dx).norm() < 1e-7);  // half a turn: the angle's digits are the limit
  });
}

TEST(EstimatorState, BoxplusOfADifferenceArrivesAtTheOtherState) {
  check_property([] {
    StateChance chance = any_chance();
    const State x = chance.state(), y = chance.state();
    const State z = boxplus(x, boxminus(y, x));
    RC_ASSERT((z.R - y.R).norm() < 1e-12);
    RC_ASSERT((z.p - y.p).norm() + (z.v - y.v).norm() + (z.b_g - y.b_g).norm() < 1e-12);
    RC_ASSERT((z.b_a - y.b_a).norm() + (z.g - y.g).norm() < 1e-12);
  });
}

TEST(EstimatorState, ADifferenceOfAStateWithItselfIsZero) {
  check_property([] {
    const State x = any_chance().state();
    RC_ASSERT(boxminus(x, x).norm() < 1e-15);
  });
}

TEST(EstimatorState, TheRotationIsPerturbedOnTheRight) {
  State x;
  x.R = Exp(Eigen::Vector3d(0, 0, std::numbers::pi / 2));
  StateVector dx = StateVector::Zero();
  dx[kTheta] = 0.1;  // about the body's x, which looks along the world's y
  EXPECT_LT((boxplus(x, dx).R - Exp(Eigen::Vector3d(0, 0.1, 0)) * x.R).norm(), 1e-12);
}

TEST(EstimatorState, EveryBlockIsWhereItsNameSays) {
  StateVector dx;
  for (int i = 0; i < kStateDim; ++i) dx[i] = 0.01 * (i + 1);
  const State y = boxplus(State{}, dx);
  EXPECT_LT((Log(y.R) - Eigen::Vector3d(0.01, 0.02, 0.03)).norm(), 1e-15);
  EXPECT_EQ(y.p, Eigen::Vector3d(dx.segment<3>(3)));
  EXPECT_EQ(y.v, Eigen::Vector3d(dx.segment<3>(6)));
  EXPECT_EQ(y.b_g, Eigen::Vector3d(dx.segment<3>(9)));
  EXPECT_EQ(y.b_a, Eigen::Vector3d(dx.segment<3>(12)));
  EXPECT_LT((y.g - Eigen::Vector3d(0.16, 0.17, 0.18 - 9.81)).norm(), 1e-15);
}

TEST(EstimatorState, TenThousandStepsLeaveARotation) {
  StateChance chance(3);
  State x = chance.state();
  for (int i = 0; i < 10'000; ++i) x = boxplus(x, error_state(chance, 0.5));
  EXPECT_LT((x.R.transpose() * x.R - Eigen::Matrix3d::Identity()).norm(), 1e-14);
  EXPECT_NEAR(x.R.determinant(), 1, 1e-14);
}

TEST(EstimatorState, BoxminusJacobianAgreesWithNumericDifferentiation) {
  check_property(
      [] {
        StateChance chance = any_chance();
        const State origin = chance.state();
        const State x = boxplus(origin, error_state(chance, 2.5));
        const StateMatrix numeric =
            test::numeric_jacobian<kStateDim>(x, [&](const State& y) { return boxminus(y, origin); });
        RC_ASSERT((numeric - boxminus_jacobian(boxminus(x, origin))).cwiseAbs().maxCoeff() < 1e-7);
      },
      200);
}

TEST(EstimatorState, CovariancesAreOfTheErrorStateAndThePoseComesFirst) {
  static_assert(StateMatrix::RowsAtCompileTime == 18 && StateMatrix::ColsAtCompileTime == 18);
  static_assert(StateVector::RowsAtCompileTime == 18);
  static_assert(kTheta == 0 && kPosition == 3, "SweepOutcome::covariance is the corner of the state's");
  EXPECT_EQ(kGravity + 3, kStateDim);
}

}  // namespace
}  // namespace lxd::estimator_state_test
