// SPDX-License-Identifier: Apache-2.0
// The Allan variance of a rate sensor at rest, and what it must be for given densities.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

namespace lxd::test {

// Overlapping estimator (NIST SP 1065, 5.2.4, on the integral of the samples) at tau = averaged * period.
// Precondition: more than 2 * averaged samples.
inline double allan_variance(std::span<const double> samples, double period_s, std::size_t averaged) {
  std::vector<double> integral{0.0};
  integral.reserve(samples.size() + 1);
  for (const double sample : samples) integral.push_back(integral.back() + sample * period_s);
  double sum = 0;
  const std::size_t terms = integral.size() - 2 * averaged;
  for (std::size_t k = 0; k < terms; ++k) {
    const double difference = integral[k + 2 * averaged] - 2 * integral[k + averaged] + integral[k];
    sum += difference * difference;
  }
  const double tau_s = static_cast<double>(averaged) * period_s;
  return sum / (2 * tau_s * tau_s * static_cast<double>(terms));
}

// White noise of density N and a bias random walk of density K (IEEE Std 952-1997, annex C): N^2 / tau + K^2 tau / 3.
inline double allan_variance_of(double noise_density, double random_walk, double tau_s) {
  return noise_density * noise_density / tau_s + random_walk * random_walk * tau_s / 3;
}

}  // namespace lxd::test
