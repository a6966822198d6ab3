// SPDX-License-Identifier: Apache-2.0
#include "estimator/innovation.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace lxd {

// L = C C^T: the eigenvectors of C^-1 A C^-T are C^T v, and y = (C^T v)^T C^T dx.
Innovation innovation(const LidarMatrix& prior_information, const LidarMatrix& measured_information,
                      const LidarVector& correction) {
  const Eigen::LLT<LidarMatrix> root(prior_information);
  if (root.info() != Eigen::Success) return {};
  const LidarMatrix half = root.matrixL().solve(measured_information);
  const LidarMatrix whitened = root.matrixL().solve(half.transpose());
  const Eigen::SelfAdjointEigenSolver<LidarMatrix> solver(0.5 * (whitened + whitened.transpose()));
  const LidarVector white = root.matrixL().transpose() * correction;
  const LidarVector y = solver.eigenvectors().transpose() * white;
  Innovation sum;
  for (int i = 0; i < kLidarDim; ++i) {
    const double m = solver.eigenvalues()[i];
    if (!(m > kInformativeShare)) continue;
    sum.squared += y[i] * y[i] * (1 + m) / m;
    ++sum.dimensions;
  }
  return std::isfinite(sum.squared) ? sum : Innovation{};
}

}  // namespace lxd
