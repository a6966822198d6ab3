// SPDX-License-Identifier: Apache-2.0
// Chance in a simulation, as named streams: every sensor, and where work is shared out every sweep and image, draws
// from a stream of its own, so that the bytes of a seed do not depend on the order of the work or on the number of
// threads. Integer arithmetic and a fixed normal transform: the same draws on every machine and standard library.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string_view>

namespace lxd::sim {

class Random {
 public:
  // A stream is named by the recording's seed, what it is for ("lidar0") and, where there are many, its number.
  Random(std::uint64_t seed, std::string_view stream, std::uint64_t number = 0) : state_(mixed(seed)) {
    for (const char c : stream) state_ = mixed(state_ ^ static_cast<unsigned char>(c));
    state_ = mixed(state_ ^ number);
  }

  std::uint64_t bits() { return mixed(state_ += kGamma); }
  double uniform() { return static_cast<double>(bits() >> 11U) * 0x1p-53; }  // [0, 1)
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  bool chance(double probability) { return uniform() < probability; }
  // Standard normal (Box-Muller, one of the pair).
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * std::numbers::pi * uniform());
  }
  double normal(double sigma) { return sigma * normal(); }

 private:
  // SplitMix64: Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
  static constexpr std::uint64_t kGamma = 0x9E3779B97F4A7C15ULL;
  static constexpr std::uint64_t mixed(std::uint64_t z) {
    z = (z ^ (z >> 30U)) * 0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27U)) * 0x94D049BB133111EBULL;
    return z ^ (z >> 31U);
  }

  std::uint64_t state_;
};

}  // namespace lxd::sim
