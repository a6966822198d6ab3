// SPDX-License-Identifier: Apache-2.0
// Summary of a set of error magnitudes.
#pragma once

#include <cstddef>
#include <vector>

namespace lxd {

struct Statistics {
  std::size_t count = 0;
  double rmse = 0, mean = 0, median = 0, p95 = 0, max = 0;  // unit of the values; 0 without values
};

// values >= 0. Percentiles interpolate linearly between the two nearest ranks.
Statistics summarise(std::vector<double> values);

}  // namespace lxd
