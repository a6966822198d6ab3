// SPDX-License-Identifier: Apache-2.0
// Summary of a set of error magnitudes.
#include "tools/evaluate/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lxd {
namespace {

double percentile(const std::vector<double>& sorted, double fraction) {
  const double rank = fraction * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(rank);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return std::lerp(sorted[below], sorted[above], rank - static_cast<double>(below));
}

}  // namespace

Statistics summarise(std::vector<double> values) {
  if (values.empty()) return {};
  std::ranges::sort(values);
  const auto count = static_cast<double>(values.size());
  const double sum = std::accumulate(values.begin(), values.end(), 0.0);
  const double squares = std::inner_product(values.begin(), values.end(), values.begin(), 0.0);
  return {values.size(),           std::sqrt(squares / count), sum / count,
          percentile(values, 0.5), percentile(values, 0.95),   values.back()};
}

}  // namespace lxd
