// SPDX-License-Identifier: Apache-2.0
// Prediction by an IMU: the state against a far finer integration, F against numeric differentiation, Q by composing
// steps and by chance, and what stays frozen.
#include <vector>

#include <gtest/gtest.h>

#include "estimator/ieskf.hpp"
#include "estimator/inertial_propagation.hpp"
#include "tests/support/chi_square.hpp"
#include "tests/support/estimator_states.hpp"
#include "tests/support/property.hpp"

namespace lxd::estimator_inertial_propagation_test {
namespace {

using Eigen::Vector3d;
using test::check_property;
using test::StateChance;

constexpr double kRateMax_radps = 6, kForceMax_mps2 = 25, kSpanMax_s = 0.02;
constexpr ImuNoise kNoise{2e-3, 3e-2, 1e-3, 1e-2};

StateChance any_chance() { return StateChance(*rc::gen::arbitrary<unsigned>()); }

InertialSpan any_span(StateChance& chance, double span_s) {
  return {span_s, chance.uniform(0, kRateMax_radps) * chance.direction(),
          chance.uniform(0, kForceMax_mps2) * chance.direction()};
}

// A state near the origin, that differences of positions keep their digits.
State any_state(StateChance& chance) {
  State x = chance.state();
  x.p = chance.vector(1);
  x.b_g = chance.vector(0.05);
  x.g = chance.vector(1) + Vector3d(0, 0, -9.81);
  return x;
}

// Steps of a thousandth, each with the attitude of its middle: wrong by a millionth of what one step can be.
State finely(const State& x, const InertialSpan& m) {
  constexpr int kSteps = 1000;
  const double dt = m.span_s / kSteps;
  const Vector3d rate = m.rate_radps - x.b_g, force = m.force_mps2 - x.b_a;
  State y = x;
  for (int i = 0; i < kSteps; ++i) {
    const Vector3d a = x.R * Exp(rate * (i + 0.5) * dt) * force + x.g;
    y.p += y.v * dt + a * (dt * dt / 2);
    y.v += a * dt;
  }
  y.R = x.R * Exp(rate * m.span_s);
  return y;
}

TEST(EstimatorInertialPropagation, TransitionAgreesWithNumericDifferentiationInEveryColumn) {
  check_property(
      [] {
        StateChance chance = any_chance();
        const State x = any_state(chance);
        const InertialSpan m = any_span(chance, chance.uniform(1e-4, kSpanMax_s));
        const State y = propagate(x, m);
        const StateMatrix F = transition(x, m), numeric = test::numeric_jacobian<kStateDim>(
                                                    x, [&](const State&at) { return boxminus(propagate(at, m), y); });
        for (int row = 0; row < kStateDim; row += 3)
          for (int column = 0; column < kStateDim; column += 3) {
            const Eigen::Matrix3d block = F.block<3, 3>(row, column);
            const double error = (block - numeric.block<3, 3>(row, column)).norm();
            RC_ASSERT(error < 1e-6 * block.norm() + 1e-9);  // 1e-9: digits of the difference
          }
      },
      300);
}

TEST(EstimatorInertialPropagation, OneStepIsAThousandFinerOnesToTheThirdOrder) {
  check_property(
      [] {
        StateChance chance = any_chance();
        const State x = any_state(chance);
        const InertialSpan m = any_span(chance, chance.uniform(1e-3, kSpanMax_s));
        const State once = propagate(x, m), exact = finely(x, m);
        // w^2 f t^3 / 24 in velocity and w^2 f t^4 / 72 in position are the first terms that are left out.
        const double t = m.span_s, rate = (m.rate_radps - x.b_g).norm();
        const double left_out = rate * rate * (m.force_mps2 - x.b_a).norm() * t * t * t;
        RC_ASSERT((once.R - exact.R).norm() < 1e-13);
        RC_ASSERT((once.v - exact.v).norm() < 1.05 * left_out / 24 + 1e-12);
        RC_ASSERT((once.p - exact.p).norm() < 1.1 * left_out * t / 72 + 1e-12);
      },
      100);
}

// Holding the attitude of the begin, as the paper does, would be wrong by w f t^2 / 2: halves to a quarter only.
TEST(EstimatorInertialPropagation, HalvingTheStepLeavesAnEighthOfTheVelocitysError) {
  StateChance chance(31);
  const State x = any_state(chance);
  InertialSpan m = any_span(chance, kSpanMax_s);
  m.rate_radps = 5 * chance.direction();
  const auto error_mps = [&](double span_s) {
    m.span_s = span_s;
    return (propagate(x, m).v - finely(x, m).v).norm();
  };
  EXPECT_NEAR(error_mps(0.02) / error_mps(0.01), 8, 0.2);
}

TEST(EstimatorInertialPropagation, AtRestNothingMoves) {
  StateChance chance(32);
  State x = any_state(chance);
  x.v.setZero();
  const InertialSpan rest{0.01, x.b_g, x.b_a - x.R.transpose() * x.g};
  State y = x;
  for (int i = 0; i < 1000; ++i) y = propagate(y, rest);
  EXPECT_LT(boxminus(y, x).norm(), 1e-10);
}

TEST(EstimatorInertialPropagation, NoiseOfTheForceComposesExactlyWhereNothingTurns) {
  const ImuNoise force_only{0, kNoise.accel_density, 0, 0};
  StateChance chance(33);
  const State x = any_state(chance);
  const InertialSpan half{0.01, x.b_g, chance.vector(10)};
  const StateMatrix F = transition(propagate(x, half), half), Q = process_noise(force_only, 0.01);
  const StateMatrix twice = F * Q * F.transpose() + Q, once = process_noise(force_only, 0.02);
  EXPECT_LT((twice - once).norm(), 1e-12 * once.norm());
}

// What noise of rate and biases does to the rest within the span is left out: relative to the deviations, it vanishes
// with the span.
TEST(EstimatorInertialPropagation, WhatTheNoiseLeavesOutVanishesWithTheSpan) {
  StateChance chance(34);
  const State x = any_state(chance);
  const auto error = [&](double span_s) {
    InertialSpan half = any_span(chance, span_s / 2);
    half.rate_radps = {0, 3, 0};
    half.force_mps2 = {0, 0, 10};
    const StateMatrix F = transition(propagate(x, half), half), Q = process_noise(kNoise, span_s / 2);
    const StateMatrix difference = F * Q * F.transpose() + Q - process_noise(kNoise, span_s);
    const Eigen::Matrix<double, 15, 1> sigma = process_noise(kNoise, span_s).diagonal().head<15>().cwiseSqrt();
    return difference.topLeftCorner<15, 15>().cwiseQuotient(sigma * sigma.transpose()).cwiseAbs().maxCoeff();
  };
  EXPECT_LT(error(0.005), 0.01);
  EXPECT_NEAR(error(0.02) / error(0.01), 2, 0.1);
}

// Truth goes in ticks of half a millisecond under what was measured less noise and walking biases; the filter in steps
// of ten ticks.
struct NoisyWalk {
  explicit NoisyWalk(StateChance& chance) : truth(any_state(chance)) {
    constexpr double kTick_s = 5e-4;
    constexpr int kSteps = 30, kTicks = 10;
    const double root = std::sqrt(kTick_s);
    filter.reset(truth, StateMatrix::Zero());
    for (int i = 0; i < kSteps; ++i) {
      const InertialSpan m{kTicks * kTick_s, {0.5, -1.5, std::sin(0.2 * i)}, {3 * std::cos(0.3 * i), 1, 9.8}};
      for (int k = 0; k < kTicks; ++k) {
        truth = propagate(truth, {kTick_s, m.rate_radps - chance.vector(kNoise.gyro_density / root),
                                  m.force_mps2 - chance.vector(kNoise.accel_density / root)});
        truth.b_g += chance.vector(kNoise.gyro_walk * root);
        truth.b_a += chance.vector(kNoise.accel_walk * root);
      }
      filter.predict(m, kNoise);
    }
  }
  State truth;
  Ieskf filter;
};

TEST(EstimatorInertialPropagation, NoiseIsThatOfIntegratedNoisySamples) {
  constexpr int kRuns = 600, kDimensions = 15;
  double squares = 0;
  for (int run = 0; run < kRuns; ++run) {
    StateChance chance(100 + run);
    const NoisyWalk walk(chance);
    const auto e = boxminus(walk.truth, walk.filter.state()).head<kDimensions>().eval();
    squares += e.dot(walk.filter.covariance().topLeftCorner<kDimensions, kDimensions>().eval().llt().solve(e));
  }
  const test::MeanBounds bounds(kDimensions, kRuns);
  RecordProperty("nees", std::to_string(squares / kRuns));
  EXPECT_GT(squares / kRuns, bounds.low);
  EXPECT_LT(squares / kRuns, bounds.high);
}

TEST(EstimatorInertialPropagation, NoiseIsACovarianceThatLeavesGravityAlone) {
  for (const double span_s : {1e-6, 1e-3, 0.02, 1.0}) {
    const StateMatrix Q = process_noise(kNoise, span_s);
    EXPECT_EQ(test::asymmetry(Q), 0);
    EXPECT_GE(test::least_relative_eigenvalue(Q), -1e-15) << span_s;
    EXPECT_EQ(Q.bottomRows<3>().cwiseAbs().maxCoeff(), 0);
  }
  EXPECT_EQ(process_noise(kNoise, 0).norm(), 0);
}

TEST(EstimatorInertialPropagation, WhatHasNoCovarianceAndDoesNotWalkStaysAsItIs) {
  // Given biases that do not walk and a gravity, all known for certain ...
  StateChance chance(35);
  const State x = any_state(chance);
  StateMatrix P = StateMatrix::Zero();
  P.diagonal().head<9>().setConstant(1e-4);
  Ieskf filter;
  filter.reset(x, P);
  for (int i = 0; i < 100; ++i) filter.predict(any_span(chance, 0.01), {2e-3, 3e-2, 0, 0});
  // ... then a hundred readings leave them so, whatever happens to the rest.
  EXPECT_EQ(filter.state().b_g, x.b_g);
  EXPECT_EQ(filter.state().b_a, x.b_a);
  EXPECT_EQ(filter.state().g, x.g);
  EXPECT_EQ((filter.covariance().bottomRows<9>().norm()), 0);
  EXPECT_GT((filter.covariance().diagonal().head<9>().minCoeff()), 1e-4);
}

TEST(EstimatorInertialPropagation, ManyReadingsKeepTheCovarianceSymmetricAndPositive) {
  StateChance chance(36);
  Ieskf filter;
  filter.reset(any_state(chance), chance.covariance<kStateDim>(0.1));
  for (int i = 0; i < 2000; ++i) {
    filter.predict(any_span(chance, 0.005), kNoise);
    ASSERT_EQ(test::asymmetry(filter.covariance()), 0);
  }
  EXPECT_GE(test::least_relative_eigenvalue(filter.covariance()), -1e-14);
}

}  // namespace
}  // namespace lxd::estimator_inertial_propagation_test
