// SPDX-License-Identifier: Apache-2.0
// States of the filter in a test: random ones, covariances of random shape, and numeric differentiation on the
// manifold.
#pragma once

#include <random>

#include <Eigen/Core>
#include <Eigen/Eigenvalues>

#include "estimator/state.hpp"

namespace lxd::test {

// Chance for the estimator's tests; a seed names a case.
class StateChance {
 public:
  explicit StateChance(unsigned seed) : random_(seed) {}

  double normal(double sigma = 1.0) { return sigma * std::normal_distribution<double>()(random_); }
  double uniform(double low, double high) { return std::uniform_real_distribution<double>(low, high)(random_); }
  Eigen::Vector3d vector(double sigma) { return {normal(sigma), normal(sigma), normal(sigma)}; }
  Eigen::Vector3d direction() { return vector(1).normalized(); }

  // Anywhere, facing anywhere, at a vehicle's speed, turning at up to some rad/s.
  State state() {
    State x;
    x.R = Exp(vector(1.0));
    x.p = vector(50);
    x.v = vector(5);
    x.b_g = vector(1.0);
    x.b_a = vector(0.1);
    return x;
  }

  // A full, positive definite covariance with correlations between all blocks.
  template <int Dim>
  Eigen::Matrix<double, Dim, Dim> covariance(double sigma) {
    Eigen::Matrix<double, Dim, Dim> A;
    for (int i = 0; i < Dim; ++i)
      for (int k = 0; k < Dim; ++k) A(i, k) = normal(sigma / Dim);
    return A * A.transpose() + 1e-3 * sigma * sigma * Eigen::Matrix<double, Dim, Dim>::Identity();
  }

 private:
  std::mt19937 random_;
};

inline constexpr double kDifferenceStep = 1e-5;  // central differences in double: about 1e-10 of the function's scale

// d f(x [+] dx) / d dx at 0, column by column; f gives a vector (of Rows) of numbers.
template <int Rows, typename F>
Eigen::Matrix<double, Rows, kStateDim> numeric_jacobian(const State& x, F&& f) {
  Eigen::Matrix<double, Rows, kStateDim> J;
  for (int i = 0; i < kStateDim; ++i) {
    const StateVector d = kDifferenceStep * StateVector::Unit(i);
    J.col(i) = (f(boxplus(x, d)) - f(boxplus(x, -d))) / (2 * kDifferenceStep);
  }
  return J;
}

// Least eigenvalue relative to the largest: not below about -1e-15 for a covariance.
template <typename Matrix>
double least_relative_eigenvalue(const Matrix& P) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(P, Eigen::EigenvaluesOnly);
  return solver.eigenvalues().minCoeff() / solver.eigenvalues().cwiseAbs().maxCoeff();
}

template <typename Matrix>
double asymmetry(const Matrix& P) {
  return (P - P.transpose()).cwiseAbs().maxCoeff();
}

}  // namespace lxd::test
