// SPDX-License-Identifier: Apache-2.0
#include "estimator/rate_information.hpp"

#include <Eigen/Cholesky>

namespace lxd {
namespace {

constexpr double kIndependentRows = 100;  // 30 to 200 do alike on walks, flights and drives; 1000 begins to lose walks
constexpr double kRounding = 1e-9;  // of the pose's information: a direction that nothing holds must not be divided by

}  // namespace

void limit_rates(std::size_t rows, NormalEquations& sums) {
  const double doubted = 1 - kIndependentRows / static_cast<double>(rows);
  if (!(doubted > 0)) return;
  const Matrix6d A_xr = sums.information.topRightCorner<6, 6>();
  Matrix6d A_xx = sums.information.topLeftCorner<6, 6>();
  A_xx.diagonal().array() += kRounding * A_xx.trace();
  const Eigen::LLT<Matrix6d> pose(A_xx);
  if (pose.info() != Eigen::Success) return;
  const Matrix6d given_way = pose.solve(A_xr);  // of the pose to the rates
  const Matrix6d S = sums.information.bottomRightCorner<6, 6>() - A_xr.transpose() * given_way;
  sums.information.bottomRightCorner<6, 6>() -= doubted * 0.5 * (S + S.transpose());
  sums.gradient.tail<6>() -= doubted * (sums.gradient.tail<6>() - given_way.transpose() * sums.gradient.head<6>());
}

}  // namespace lxd
