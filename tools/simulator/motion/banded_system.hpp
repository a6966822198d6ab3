// SPDX-License-Identifier: Apache-2.0
// Normal equations of a spline's control points: symmetric, positive definite, with a band as wide as the basis.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <Eigen/Core>

#include "tools/simulator/motion/spline_basis.hpp"

namespace lxd::sim {

class BandedSystem {
 public:
  using Values = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic>;  // a row a control point, a column a coordinate

  BandedSystem(std::size_t unknowns, std::size_t coordinates);

  // Adds weight * (sum_j coefficients[j] x[first + j] - value)^2; at most kSplineOrder coefficients.
  void add(std::size_t first, std::span<const double> coefficients, const Eigen::VectorXd& value, double weight);
  void add(std::size_t first, std::span<const double> coefficients, double weight);  // wanted: zero

  // Where the sum of all is least. Leaves the system used up.
  [[nodiscard]] Values solve();

 private:
  void factorise();

  static constexpr std::ptrdiff_t kBand = kSplineOrder - 1;
  // Row i: A(i, i) .. A(i, i + kBand), then of the factor L^T with a unit diagonal and D on it.
  Eigen::Matrix<double, Eigen::Dynamic, kSplineOrder, Eigen::RowMajor> upper_;
  Values right_;
};

}  // namespace lxd::sim
