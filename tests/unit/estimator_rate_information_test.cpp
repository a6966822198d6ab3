// SPDX-License-Identifier: Apache-2.0
// How much is believed of what a sweep's skew tells of the rates.
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "estimator/rate_information.hpp"
#include "tests/support/estimator_states.hpp"

namespace lxd::estimator_rate_information_test {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kRows = 1000, kBelieved = 100;

// Points on the walls across the first `axes` axes of a room, fired over 0.1 s, with residuals of some state that is
// wrong.
NormalEquations room(std::size_t rows, int axes = 3) {
  test::StateChance chance(43);
  std::vector<PointResidual> residuals;
  for (std::size_t i = 0; i < rows; ++i) {
    const int axis = static_cast<int>(i) % axes;
    Vector3d p = chance.vector(4.0);
    p[axis] = i % 2 == 0 ? 5 : -5;
    const Vector3d n = (i % 2 == 0 ? -1.0 : 1.0) * Vector3d::Unit(axis);
    const PathKnot knot = SweepPath::knot(State{}, chance.uniform(0, 0.1));
    residuals.push_back(point_to_surface({p, 0, 4e-4F}, knot, {0, 0, n.cast<float>()}));
    residuals.back().r_m = chance.uniform(-0.02, 0.02);
  }
  return accumulate(residuals, 1, 1e9);
}

// What is told of the rates when the pose is free.
Matrix6d of_rates(const NormalEquations& sums) {
  const LidarMatrix& A = sums.information;
  return A.bottomRightCorner<6, 6>() -
         A.bottomLeftCorner<6, 6>() * A.topLeftCorner<6, 6>().ldlt().solve(A.topRightCorner<6, 6>());
}

// Given a thousand rows, when a hundred are believed to be independent, then the rates are told by a tenth, and the
// pose for given rates as before.
TEST(EstimatorRateInformation, RatesAreToldByTheIndependentRowsOnly) {
  const NormalEquations whole = room(kRows);
  NormalEquations limited = whole;
  limit_rates(kRows, limited);
  const Matrix6d wanted = of_rates(whole) * static_cast<double>(kBelieved) / kRows;
  EXPECT_LT((of_rates(limited) - wanted).norm(), 1e-6 * wanted.norm());
  const auto of_pose = [](const NormalEquations& sums) { return sums.information.topRows<6>(); };
  EXPECT_LT((of_pose(limited) - of_pose(whole)).norm(), 1e-6 * of_pose(whole).norm());
  EXPECT_EQ((limited.gradient.head<6>()), (whole.gradient.head<6>()));
  EXPECT_LT((limited.information - limited.information.transpose()).norm(), 1e-12 * limited.information.norm());
}

// The measurement stays where it was: only its variance grows.
TEST(EstimatorRateInformation, WhatIsMeasuredStaysWhereItWas) {
  const NormalEquations whole = room(kRows);
  NormalEquations limited = whole;
  limit_rates(kRows, limited);
  const LidarVector before = whole.information.ldlt().solve(whole.gradient);
  const LidarVector after = limited.information.ldlt().solve(limited.gradient);
  EXPECT_LT((after - before).norm(), 1e-5 * before.norm());
}

TEST(EstimatorRateInformation, FewRowsAreBelievedAsTheyAre) {
  for (const std::size_t rows : {kBelieved - 1, kBelieved}) {
    const NormalEquations whole = room(rows);
    NormalEquations limited = whole;
    limit_rates(rows, limited);
    EXPECT_EQ(limited.information, whole.information) << rows;
    EXPECT_EQ(limited.gradient, whole.gradient) << rows;
  }
  NormalEquations beyond = room(kBelieved + 1);
  const Matrix6d before = of_rates(beyond);
  limit_rates(kBelieved + 1, beyond);
  EXPECT_LT(of_rates(beyond).trace(), before.trace());
}

// Given walls across one axis, which leave three directions of the pose open, and none at all; then no number is lost
// and no direction is told negatively.
TEST(EstimatorRateInformation, OpenDirectionsStayOpen) {
  NormalEquations open = room(kRows, 1);
  limit_rates(kRows, open);
  ASSERT_TRUE(open.information.allFinite() && open.gradient.allFinite());
  const Eigen::SelfAdjointEigenSolver<LidarMatrix> axes(open.information);
  EXPECT_GT(axes.eigenvalues()[0], -1e-14 * axes.eigenvalues()[kLidarDim - 1]);
  NormalEquations nothing;
  limit_rates(kRows, nothing);
  EXPECT_TRUE(nothing.information.isZero() && nothing.gradient.isZero());
}

}  // namespace
}  // namespace lxd::estimator_rate_information_test
