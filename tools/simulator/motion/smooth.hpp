// SPDX-License-Identifier: Apache-2.0
// Smoothing of evenly sampled curves by four running means: their joint kernel is a cubic B-spline, so what had corners
// is four times continuously differentiable afterwards. Beyond the ends the end values go on.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

namespace lxd::sim {

inline constexpr int kSmoothPasses = 4;

// Reaches kSmoothPasses * half_width samples to either side. `zero` of the values' type. Where all values within reach
// are zero the result is exactly zero.
template <typename T>
void smooth(std::vector<T>& values, std::ptrdiff_t half_width, const T& zero) {
  if (half_width <= 0 || values.empty()) return;
  const auto n = static_cast<std::ptrdiff_t>(values.size());
  const double share = 1.0 / static_cast<double>(2 * half_width + 1);
  for (int pass = 0; pass < kSmoothPasses; ++pass) {
    const std::vector<T> before = values;  // summed anew each time: a running sum would leave its rounding as jitter
    for (std::ptrdiff_t i = 0; i < n; ++i) {
      T sum = zero;
      for (std::ptrdiff_t k = i - half_width; k <= i + half_width; ++k)
        sum += before[std::clamp<std::ptrdiff_t>(k, 0, n - 1)];
      values[i] = share * sum;
    }
  }
}

}  // namespace lxd::sim
