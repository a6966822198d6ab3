// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/banded_system.hpp"

#include <algorithm>
#include <utility>

namespace lxd::sim {

BandedSystem::BandedSystem(std::size_t unknowns, std::size_t coordinates)
    : upper_(unknowns, kSplineOrder), right_(unknowns, coordinates) {
  upper_.setZero();
  right_.setZero();
}

void BandedSystem::add(std::size_t first, std::span<const double> coefficients, double weight) {
  for (std::size_t i = 0; i < coefficients.size(); ++i)
    for (std::size_t k = i; k < coefficients.size(); ++k)
      upper_(first + i, k - i) += weight * coefficients[i] * coefficients[k];
}

void BandedSystem::add(std::size_t first, std::span<const double> coefficients, const Eigen::VectorXd& value,
                       double weight) {
  add(first, coefficients, weight);
  for (std::size_t i = 0; i < coefficients.size(); ++i)
    right_.row(first + i) += weight * coefficients[i] * value.transpose();
}

// A = L D L^T, row by row: Golub, Van Loan, "Matrix Computations", 4.3 (banded) and 4.1 (LDL^T).
void BandedSystem::factorise() {
  const std::ptrdiff_t n = upper_.rows();
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const std::ptrdiff_t reach = std::min(kBand, n - 1 - i);
    for (std::ptrdiff_t j = 1; j <= reach; ++j) {
      const double factor = upper_(i, j) / upper_(i, 0);
      for (std::ptrdiff_t k = j; k <= reach; ++k) upper_(i + j, k - j) -= factor * upper_(i, k);
    }
    for (std::ptrdiff_t j = 1; j <= reach; ++j) upper_(i, j) /= upper_(i, 0);
  }
}

BandedSystem::Values BandedSystem::solve() {
  factorise();
  const std::ptrdiff_t n = upper_.rows();
  for (std::ptrdiff_t i = 0; i < n; ++i)
    for (std::ptrdiff_t j = 1; j <= std::min(kBand, n - 1 - i); ++j) right_.row(i + j) -= upper_(i, j) * right_.row(i);
  for (std::ptrdiff_t i = n - 1; i >= 0; --i) {
    right_.row(i) /= upper_(i, 0);
    for (std::ptrdiff_t j = 1; j <= std::min(kBand, n - 1 - i); ++j) right_.row(i) -= upper_(i, j) * right_.row(i + j);
  }
  return std::move(right_);
}

}  // namespace lxd::sim
