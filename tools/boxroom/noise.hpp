// SPDX-License-Identifier: Apache-2.0
// The one source of chance in a recording. Draws follow each other in a fixed order: a seed names a recording.
#pragma once

#include <cstdint>
#include <random>

namespace lxd::boxroom {

class Noise {
 public:
  explicit Noise(std::uint32_t seed) : engine_(seed) {}

  double uniform(double low, double span) { return low + span * uniform_(engine_); }
  double normal(double sigma) { return sigma * normal_(engine_); }

 private:
  std::mt19937 engine_;
  std::uniform_real_distribution<double> uniform_{0, 1};
  std::normal_distribution<double> normal_{0, 1};
};

}  // namespace lxd::boxroom
