// SPDX-License-Identifier: Apache-2.0
// Smooth chance: what sways, shakes and wanders without a period that shows.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "tools/simulator/random.hpp"

namespace lxd::sim {

// A sum of sines of random frequency within a band; zero mean, unit variance over time.
class Wander {
 public:
  Wander(Random& random, double low_hz, double high_hz) {
    double power = 0;
    for (Wave& wave : waves_) {
      wave = {2 * std::numbers::pi * random.uniform(low_hz, high_hz), random.uniform(0, 2 * std::numbers::pi),
              random.uniform(kLeast, 1)};
      power += wave.amplitude * wave.amplitude / 2;
    }
    for (Wave& wave : waves_) wave.amplitude /= std::sqrt(power);
  }

  double operator()(double t_s) const {
    double sum = 0;
    for (const Wave& wave : waves_) sum += wave.amplitude * std::sin(wave.radps * t_s + wave.phase);
    return sum;
  }

 private:
  struct Wave {
    double radps, phase, amplitude;
  };
  static constexpr double kLeast = 0.3;
  static constexpr std::size_t kWaves = 10;
  std::array<Wave, kWaves> waves_;
};

// 0 up to begin, 1 from begin + length on; three times continuously differentiable.
inline double eased(double t_s, double begin_s, double length_s) {
  const double u = std::clamp((t_s - begin_s) / length_s, 0.0, 1.0);
  return u * u * u * u * (35 + u * (-84 + u * (70 - 20 * u)));
}

}  // namespace lxd::sim
