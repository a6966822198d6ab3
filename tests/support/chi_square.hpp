// SPDX-License-Identifier: Apache-2.0
// Bounds for sums of squared normalised errors, to tell a consistent filter from one that is not.
#pragma once

#include <cmath>

namespace lxd::test {

// Quantile of the chi-square distribution at the standard normal quantile z (Wilson & Hilferty 1931: within 0.1 % from
// 100 degrees of freedom on, for |z| <= 4).
inline double chi_square_quantile(double degrees, double z) {
  const double a = 2 / (9 * degrees);
  return degrees * std::pow(1 - a + z * std::sqrt(a), 3);
}

// Mean of `runs` squares of `degrees` each: where it lies in all but one of 1000 cases when the covariance is right.
struct MeanBounds {
  MeanBounds(int degrees, int runs)
      : low(chi_square_quantile(degrees * runs, -kZ) / runs), high(chi_square_quantile(degrees * runs, kZ) / runs) {}
  static constexpr double kZ = 3.29;  // two-sided 0.1 %
  double low, high;
};

}  // namespace lxd::test
