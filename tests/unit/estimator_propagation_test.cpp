// SPDX-License-Identifier: Apache-2.0
// Prediction: F against numeric differentiation, Q by composing steps, and what many steps leave of a covariance.
#include <gtest/gtest.h>

#include "estimator/ieskf.hpp"
#include "estimator/propagation.hpp"
#include "tests/support/estimator_states.hpp"
#include "tests/support/property.hpp"

namespace lxd::estimator_propagation_test {
namespace {

using test::check_property;
using test::StateChance;

constexpr ConstantVelocityNoise kNoise{1.3, 2.1};

StateChance any_chance() { return StateChance(*rc::gen::arbitrary<unsigned>()); }

// Position and velocity rows and columns alone: there the model is linear.
Matrix6d linear_part(const StateMatrix& M) { return M.block<6, 6>(kPosition, kPosition); }

// What one noisy step of dt adds, and what two of half as long add.
struct ComposedNoise {
  StateMatrix once, twice;
};

ComposedNoise composed(const State& x, double dt_s) {
  const State middle = propagate(x, dt_s / 2);
  const StateMatrix F = transition(middle, dt_s / 2), half = process_noise(kNoise, dt_s / 2);
  return {process_noise(kNoise, dt_s), F * half * F.transpose() + half};
}

TEST(EstimatorPropagation, TransitionAgreesWithNumericDifferentiation) {
  check_property(
      [] {
        StateChance chance = any_chance();
        const State x = chance.state();
        const double dt_s = chance.uniform(0.0, 0.5);
        const State y = propagate(x, dt_s);
        const StateMatrix numeric = test::numeric_jacobian<kStateDim>(
            x, [&](const State& perturbed) { return boxminus(propagate(perturbed, dt_s), y); });
        RC_ASSERT((numeric - transition(x, dt_s)).cwiseAbs().maxCoeff() < 1e-7);
      },
      300);
}

TEST(EstimatorPropagation, WhatMovesSteadilyIsWhereItsRatesTakeIt) {
  State x;
  x.v = {1, 2, -3};
  x.b_g = {0, 0, -0.4};  // minus the rate
  const State y = propagate(x, 0.5);
  EXPECT_LT((y.p - Eigen::Vector3d(0.5, 1, -1.5)).norm(), 1e-15);
  EXPECT_LT((Log(y.R) - Eigen::Vector3d(0, 0, 0.2)).norm(), 1e-15);
  EXPECT_EQ(y.v, x.v);
  EXPECT_EQ(y.b_g, x.b_g);
}

TEST(EstimatorPropagation, OneStepOfStateAndTransitionEqualsTwoHalves) {
  check_property(
      [] {
        StateChance chance = any_chance();
        const State x = chance.state();
        const double dt_s = chance.uniform(0.01, 0.5);
        const State middle = propagate(x, dt_s / 2), end = propagate(x, dt_s);
        RC_ASSERT(boxminus(propagate(middle, dt_s / 2), end).norm() < 1e-12);
        const StateMatrix twice = transition(middle, dt_s / 2) * transition(x, dt_s / 2);
        RC_ASSERT((twice - transition(x, dt_s)).cwiseAbs().maxCoeff() < 1e-12);
      },
      300);
}

TEST(EstimatorPropagation, NoiseOfPositionAndVelocityComposesExactly) {
  check_property(
      [] {
        StateChance chance = any_chance();
        const ComposedNoise Q = composed(chance.state(), chance.uniform(0.01, 2.0));
        RC_ASSERT((linear_part(Q.once) - linear_part(Q.twice)).cwiseAbs().maxCoeff() < 1e-12);
      },
      300);
}

TEST(EstimatorPropagation, NoiseOfRotationComposesExactlyWhereNothingTurns) {
  StateChance chance(5);
  State x = chance.state();
  x.b_g.setZero();
  const ComposedNoise Q = composed(x, 0.3);
  EXPECT_LT((Q.once - Q.twice).cwiseAbs().maxCoeff(), 1e-15);
}

// Q neglects the turn within dt: what is wrong by it must vanish as the turn does, that is with dt * rate.
TEST(EstimatorPropagation, NoiseOfRotationComposesToFirstOrderInTheTurn) {
  StateChance chance(6);
  State x = chance.state();
  x.b_g = {0.6, -0.3, 0.9};
  const auto error = [&](double dt_s) {
    const ComposedNoise Q = composed(x, dt_s);
    const auto scale = Q.once.block<3, 3>(kTheta, kGyroBias).norm();
    return (Q.once - Q.twice).block<3, 3>(kTheta, kGyroBias).norm() / scale;
  };
  EXPECT_LT(error(0.1), 0.1 * x.b_g.norm());
  EXPECT_NEAR(error(0.1) / error(0.05), 2, 0.1);
}

TEST(EstimatorPropagation, NoiseIsThatOfIntegratedWhiteAcceleration) {
  // Given accelerations that are constant for a millisecond, drawn with the variance of the white noise over it ...
  StateChance chance(7);
  constexpr double kTick_s = 1e-3, kSpan_s = 0.1;
  constexpr int kRuns = 20'000;
  Eigen::Matrix2d sums = Eigen::Matrix2d::Zero();
  for (int run = 0; run < kRuns; ++run) {
    Eigen::Vector2d pv = Eigen::Vector2d::Zero();
    for (int k = 0; k < static_cast<int>(kSpan_s / kTick_s); ++k) {
      const double a = chance.normal(kNoise.acceleration_density / std::sqrt(kTick_s));
      pv += Eigen::Vector2d(pv[1] * kTick_s + a * kTick_s * kTick_s / 2, a * kTick_s);
    }
    sums += pv * pv.transpose() / kRuns;
  }
  // ... then position and velocity scatter as Q says, within four standard errors of a variance.
  const StateMatrix Q = process_noise(kNoise, kSpan_s);
  const double tolerance = 4 * std::sqrt(2.0 / kRuns);
  EXPECT_NEAR(sums(0, 0) / Q(kPosition, kPosition), 1, tolerance);
  EXPECT_NEAR(sums(0, 1) / Q(kPosition, kVelocity), 1, tolerance);
  EXPECT_NEAR(sums(1, 1) / Q(kVelocity, kVelocity), 1, tolerance);
}

TEST(EstimatorPropagation, NoiseIsACovarianceAndLeavesTheFrozenBlocksAlone) {
  for (const double dt_s : {1e-6, 1e-3, 0.1, 1.0, 100.0}) {
    const StateMatrix Q = process_noise(kNoise, dt_s);
    EXPECT_EQ(test::asymmetry(Q), 0);
    EXPECT_GE(test::least_relative_eigenvalue(Q), -1e-15) << dt_s;
    EXPECT_EQ((Q.bottomRows<6>().cwiseAbs().maxCoeff()), 0);
  }
  EXPECT_EQ(process_noise(kNoise, 0).norm(), 0);
}

TEST(EstimatorPropagation, AThousandPredictionsKeepTheCovarianceSymmetricAndPositive) {
  StateChance chance(8);
  Ieskf filter;
  StateMatrix P = StateMatrix::Zero();
  P.topLeftCorner<kLidarDim, kLidarDim>() = chance.covariance<kLidarDim>(0.5);
  filter.reset(chance.state(), P);
  for (int i = 0; i < 1000; ++i) {
    filter.predict(chance.uniform(0.001, 0.2), kNoise);
    ASSERT_EQ(test::asymmetry(filter.covariance()), 0);
    ASSERT_GE(test::least_relative_eigenvalue(filter.covariance()), -1e-14) << i;
  }
}

TEST(EstimatorPropagation, PredictionsGrowEveryActiveVarianceAndNoFrozenOne) {
  Ieskf filter;
  filter.reset(StateChance(9).state(), StateMatrix::Zero());
  filter.predict(0.1, kNoise);
  EXPECT_GT(filter.covariance().diagonal().head<kLidarDim>().minCoeff(), 0);
  EXPECT_EQ(filter.covariance().diagonal().tail<kStateDim - kLidarDim>().maxCoeff(), 0);
}

}  // namespace
}  // namespace lxd::estimator_propagation_test
