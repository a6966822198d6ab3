// SPDX-License-Identifier: Apache-2.0
// The NIS is the textbook's where the problem is linear, is chi^2 distributed over many seeded updates, and finds out
// priors that are too sure of themselves or not sure enough.
#include <gtest/gtest.h>

#include "estimator/innovation.hpp"
#include "tests/support/chi_square.hpp"
#include "tests/support/wall_returns.hpp"

namespace lxd::estimator_innovation_test {
namespace {

using test::MeanBounds;
using test::StateChance;

LidarVector drawn(const LidarMatrix& P, StateChance& chance) {
  LidarVector white;
  for (int i = 0; i < kLidarDim; ++i) white[i] = chance.normal();
  return P.llt().matrixL() * white;
}

TEST(EstimatorInnovation, OfThreeMeasuredNumbersIsTheTextbooks) {
  // Given three numbers measured with noise R about a correlated prior ...
  StateChance chance(71);
  const LidarMatrix P = chance.covariance<kLidarDim>(0.3);
  Eigen::Matrix<double, 3, kLidarDim> H = Eigen::Matrix<double, 3, kLidarDim>::Zero();
  H.middleCols<3>(kPosition).setIdentity();
  H.middleCols<3>(kVelocity) = -0.05 * Eigen::Matrix3d::Identity();
  const Eigen::Vector3d nu(0.1, -0.2, 0.05);
  const Eigen::Matrix3d R = Eigen::Vector3d(1e-3, 2e-3, 4e-3).asDiagonal();
  const Eigen::Matrix3d S = H * P * H.transpose() + R;
  const LidarVector correction = P * H.transpose() * S.inverse() * nu;
  // ... then what the correction tells is nu^T S^-1 nu.
  const Innovation found = innovation(P.inverse(), H.transpose() * R.inverse() * H, correction);
  EXPECT_EQ(found.dimensions, 3);
  EXPECT_NEAR(found.squared, nu.dot(S.inverse() * nu), 1e-9);
}

TEST(EstimatorInnovation, WhatIsHardlyMeasuredDoesNotCount) {
  LidarMatrix measured = LidarMatrix::Zero();
  measured.diagonal().head<6>().setConstant(100);
  measured.diagonal().tail<6>().setConstant(0.5 * kInformativeShare);
  EXPECT_EQ(innovation(LidarMatrix::Identity(), measured, LidarVector::Ones()).dimensions, 6);
}

TEST(EstimatorInnovation, WithoutASoundPriorThereIsNone) {
  const LidarMatrix one = LidarMatrix::Identity();
  EXPECT_EQ(innovation(-one, one, LidarVector::Ones()).dimensions, 0);
  EXPECT_EQ(innovation(one, one, LidarVector::Constant(NAN)).dimensions, 0);
}

// Updates from walls whose noise is known; truth is drawn about the prior with `share` of the covariance it claims.
double mean_nis(int runs, double share) {
  const StateMatrix P = test::prior_covariance(0.02, 0.05, 0.3, 0.2);
  double sum = 0;
  for (int run = 0; run < runs; ++run) {
    StateChance chance(7000 + run);
    const State prior = test::carrier(chance);
    StateVector away = StateVector::Zero();
    away.head<kLidarDim>() = drawn(share * P.topLeftCorner<kLidarDim, kLidarDim>(), chance);
    Ieskf filter;
    filter.reset(prior, P);
    EXPECT_TRUE(test::update(filter, test::wall_sweep(boxplus(prior, away), 300, test::kSigma_m, chance), test::plain));
    EXPECT_EQ(filter.innovation().dimensions, kLidarDim);
    sum += filter.innovation().squared;
  }
  return sum / runs;
}

TEST(EstimatorInnovation, OfAConsistentFilterAveragesItsDimensions) {
  constexpr int kRuns = 300;
  const MeanBounds bounds(kLidarDim, kRuns);
  const double nis = mean_nis(kRuns, 1);
  RecordProperty("nis", std::to_string(nis));
  EXPECT_GT(nis, bounds.low);
  EXPECT_LT(nis, bounds.high);
}

TEST(EstimatorInnovation, ASelfConfidentAndATimidPriorAreFoundOut) {
  constexpr int kRuns = 100;
  const MeanBounds bounds(kLidarDim, kRuns);
  EXPECT_GT(mean_nis(kRuns, 2), bounds.high);
  EXPECT_LT(mean_nis(kRuns, 0.5), bounds.low);
}

}  // namespace
}  // namespace lxd::estimator_innovation_test
