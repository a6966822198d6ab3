// SPDX-License-Identifier: Apache-2.0
// The turn between two images by their features alone: far ones, near ones that move by parallax, outliers, too few.
#include <cmath>

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
  // Features at 5 to 50 m before a camera that turns and moves.
  void look(int count, const Matrix3d& R_now_before, const Vector3d& t_m, int outliers = 0) {
    before = now = {};
    for (int i = 0; i < count; ++i) {
      const Vector3d p = chance.uniform(5, 50) * Vector3d(chance.normal(0.4), chance.normal(0.3), 1);
      add(before, i, p);
      add(now, i, i < outliers ? Vector3d(p + chance.vector(20)) : Vector3d(R_now_before * p + t_m));
    }
  }
  void add(FeatureFrame& frame, int id, const Vector3d& p) {
    const Vector3d b = (p.normalized() + kSigma_rad * chance.vector(1)).normalized();
    frame.storage[frame.count++] = {static_cast<std::uint32_t>(id + 1),
                                    0,
                                    {},
                                    {static_cast<float>(b.x()), static_cast<float>(b.y()), static_cast<float>(b.z())}};
  }
  [[nodiscard]] double error(const Matrix3d& truth) const { return Log(truth.transpose() * guess.R_now_before).norm(); }

  test::StateChance chance{12};
  FeatureFrame before, now;
  TurnGuess guess{};
};

TEST_F(TurnGuessTest, FindsALargeTurnWithinItsCovariance) {
  double nees = 0;
  constexpr int kRuns = 100;
  for (int run = 0; run < kRuns; ++run) {
    const Matrix3d R = Exp(chance.vector(0.4));
    look(100, R, Vector3d::Zero());
    ASSERT_TRUE(guess_turn(before, now, Matrix3d::Identity(), kSigma_rad, guess));
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
  ASSERT_TRUE(guess_turn(before, now, Matrix3d::Identity(), kSigma_rad, guess));
  EXPECT_LT(error(R), 0.006);
}

TEST_F(TurnGuessTest, TooFewOrNoNumbersAreNoGuess) {
  look(7, Matrix3d::Identity(), Vector3d::Zero());
  EXPECT_FALSE(guess_turn(before, now, Matrix3d::Identity(), kSigma_rad, guess));
  look(8, Matrix3d::Identity(), Vector3d::Zero());
  EXPECT_TRUE(guess_turn(before, now, Matrix3d::Identity(), kSigma_rad, guess));
  now.storage[3].bearing[0] = NAN;
  EXPECT_FALSE(guess_turn(before, now, Matrix3d::Identity(), kSigma_rad, guess));
  EXPECT_FALSE(guess_turn({}, {}, Matrix3d::Identity(), kSigma_rad, guess));
  for (Feature& feature : now.storage) feature.id += 1000;
  EXPECT_FALSE(guess_turn(before, now, Matrix3d::Identity(), kSigma_rad, guess));
}

}  // namespace
}  // namespace lxd::estimator_turn_guess_test
