// SPDX-License-Identifier: Apache-2.0
#include "estimator/rate_information.hpp"

#include <algorithm>

#include <Eigen/Cholesky>

namespace lxd {
namespace {

constexpr double kIndependentRows = 100;  // README.md says what more and fewer do
constexpr double kRounding = 1e-9;  // of the pose's information: a direction that nothing holds must not be divided by

}  // namespace

double doubted_share(std::size_t rows) {
  return std::max(0.0, 1 - kIndependentRows / static_cast<double>(std::max<std::size_t>(rows, 1)));
}

// (1 - doubted) A + doubted [I G]^T A_xx [I G], G = A_xx^-1 A_xr: no eigenvalue becomes negative, however weak A_xx is.
void limit_rates(std::size_t rows, NormalEquations& sums) {
  const double doubted = doubted_share(rows);
  if (!(doubted > 0)) return;
  const Matrix6d A_xx = sums.information.topLeftCorner<6, 6>();
  const Eigen::LLT<Matrix6d> held(A_xx + kRounding * A_xx.trace() * Matrix6d::Identity());
  if (held.info() != Eigen::Success) return;
  Eigen::Matrix<double, 6, kLidarDim> pose;  // how it gives way to the rates
  pose << Matrix6d::Identity(), held.solve(sums.information.topRightCorner<6, 6>());
  const LidarVector gradient = pose.transpose() * sums.gradient.head<6>();
  sums.information += doubted * (pose.transpose() * A_xx * pose - sums.information);
  sums.gradient += doubted * (gradient - sums.gradient);
}

}  // namespace lxd
