// SPDX-License-Identifier: Apache-2.0
// Ieskf::correct, for measurements of any few dimensions. Included by ieskf.hpp.
#pragma once

#include <Eigen/Cholesky>

#include "estimator/ieskf.hpp"

namespace lxd {

template <int Dim>
double Ieskf::surprise(const Measurement<Dim>& m) const {
  const Eigen::Matrix<double, Dim, Dim> S = m.H * P_ * m.H.transpose() + m.R;
  return m.r.dot(S.llt().solve(m.r));
}

// Joseph's form, so that rounding leaves the covariance positive.
template <int Dim>
void Ieskf::correct(const Measurement<Dim>& m) {
  const Eigen::Matrix<double, kStateDim, Dim> PHt = P_ * m.H.transpose();
  const Eigen::Matrix<double, Dim, Dim> S = m.H * PHt + m.R;
  const Eigen::Matrix<double, kStateDim, Dim> K = S.llt().solve(PHt.transpose()).transpose();
  const StateMatrix keep = StateMatrix::Identity() - K * m.H;
  P_ = (keep * P_ * keep.transpose() + K * m.R * K.transpose()).eval();
  P_ = 0.5 * (P_ + P_.transpose()).eval();
  delay_.correct(keep);
  mount_.correct(keep);
  x_ = prior_ = boxplus(x_, -K * m.r);
}

}  // namespace lxd
