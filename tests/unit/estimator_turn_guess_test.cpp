// SPDX-License-Identifier: Apache-2.0
// The turn between two images by their features alone: far ones, near ones that move by parallax, outliers, too few.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/vision/turn_guess.hpp"
#include "tests/support/estimator_states.hpp"

namespace lxd::estimator_turn_guess_test {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kSigma_rad = 0.001;

class TurnGuessTest : public testing::Test {
 protected:
  // Features at `near_m` to 50 m before a camera that turns and moves, t_m of what was before seen from now.
  void look(int count, const Matrix3d& R_now_before, const Vector3d& t_m, int outliers = 0, double near_m = 5) {
    pairs.clear();
    for (int i = 0; i < count; ++i) {
      const Vector3d p = chance.uniform(near_m, 50) * Vector3d(chance.normal(0.4), chance.normal(0.3), 1);
      const Vector3d now = i < outliers ? Vector3d(p + chance.vector(20)) : Vector3d(R_now_before * p + t_m);
      pairs.push_back({blurred(p), blurred(now)});
      if (distances) pairs.back().rho = (1 + chance.normal(0.02)) / p.norm();
      pairs.back().rho_sigma = distances ? 0.02 / p.norm() : 0;
    }
  }
  [[nodiscard]] bool guessed(const TurnExpected& expected = {}) {
    return guess_turn(pairs, expected, kSigma_rad, guess);
  }
  [[nodiscard]] Vector3d blurred(const Vector3d& p) {
    return (p.normalized() + kSigma_rad * chance.vector(1)).normalized();
  }
  [[nodiscard]] double error(const Matrix3d& truth) const { return Log(truth.transpose() * guess.R_now_before).norm(); }

  test::StateChance chance{12};
  std::vector<TurnPair> pairs;
  bool distances = false;
  TurnGuess guess{};
};

TEST_F(TurnGuessTest, FindsALargeTurnWithinItsCovariance) {
  double nees = 0;
  constexpr int kRuns = 100;
  for (int run = 0; run < kRuns; ++run) {
    const Matrix3d R = Exp(chance.vector(0.4));
    look(100, R, Vector3d::Zero());
    ASSERT_TRUE(guessed());
    EXPECT_EQ(guess.features, 100U);
    EXPECT_GT(guess.agreement, 0.5);
    EXPECT_LT(error(R), 0.002);
    const Vector3d e = Log(guess.R_now_before.transpose() * R);
    nees += e.dot(guess.covariance_rad2.ldlt().solve(e));
  }
  EXPECT_GT(nees / kRuns, 1.5);
  EXPECT_LT(nees / kRuns, 4.5);
}

// Walking pace at ten images a second, and a fifth of the features on things that move.
TEST_F(TurnGuessTest, ParallaxAndOutliersMoveItLittle) {
  const Matrix3d R = Exp(Vector3d(0.05, -0.12, 0.08));
  look(150, R, {0.05, 0, 0.1}, 30);
  ASSERT_TRUE(guessed());
  EXPECT_LT(error(R), 0.006);
}

// In a room, from a way that is expected a centimetre or two off: with distances the turn is found all the same.
TEST_F(TurnGuessTest, KnownDistancesTakeTheParallaxOut) {
  distances = true;
  const Matrix3d R = Exp(Vector3d(0.05, -0.12, 0.08));
  const Vector3d t(0.05, 0, 0.1), wrong(0.02, -0.01, 0.01);
  double nees = 0;
  constexpr int kRuns = 50;
  for (int run = 0; run < kRuns; ++run) {
    look(150, R, t, 30, 1.5);
    ASSERT_TRUE(guessed({{Matrix3d::Identity(), t + wrong}, 0.02}));
    EXPECT_LT(error(R), 0.0015);
    const Vector3d e = Log(guess.R_now_before.transpose() * R);
    nees += e.dot(guess.covariance_rad2.ldlt().solve(e));
  }
  EXPECT_LT(nees / kRuns, 6);
}

TEST_F(TurnGuessTest, TooFewOrNoNumbersAreNoGuess) {
  look(7, Matrix3d::Identity(), Vector3d::Zero());
  EXPECT_FALSE(guessed());
  look(8, Matrix3d::Identity(), Vector3d::Zero());
  EXPECT_TRUE(guessed());
  pairs[3].now.x() = NAN;
  EXPECT_FALSE(guessed());
  pairs.clear();
  EXPECT_FALSE(guessed());
}

}  // namespace
}  // namespace lxd::estimator_turn_guess_test
