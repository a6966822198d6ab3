// SPDX-License-Identifier: Apache-2.0
// Propagation of state and covariance (paper, "Configuration-Adaptive Kinematic State Propagation"). This slice has the
// last step of the hierarchy: constant velocity, driven by white noise on the accelerations.
#pragma once

#include "estimator/state.hpp"

namespace lxd {

// Roots of power spectral densities.
struct ConstantVelocityNoise {
  double acceleration_density;          // m/s^2/sqrt(Hz)
  double angular_acceleration_density;  // rad/s^2/sqrt(Hz)
};

// What a carrier may do of which nothing is known.
struct RateSigmas {
  double speed_mps, rate_radps;
};

// A time without sweeps. Up to `known_s` the rates carry the pose on; from then on it is held, and the rates are
// forgotten: k = known_s / span_s of them stays.
struct Gap {
  double span_s, known_s;  // span_s > known_s > 0
  RateSigmas unknown;

  [[nodiscard]] double keep() const { return known_s / span_s; }
};

// x(t + dt) when nothing accelerates.
State propagate(const State& x, double dt_s);

// d propagate(x [+] dx, dt) / d dx: F_i of the paper with the measured rate and force at zero.
StateMatrix transition(const State& x, double dt_s);

// Covariance that the white noise adds over dt: Q_i.
StateMatrix process_noise(const ConstantVelocityNoise& noise, double dt_s);

// x and P, predicted over gap.known_s, at the gap's end. Continuous at span_s = known_s, bounded however long it is.
State held(const State& x, const Gap& gap);
StateMatrix held(const StateMatrix& P, const Gap& gap);

}  // namespace lxd
