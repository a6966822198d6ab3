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

// x(t + dt) when nothing accelerates.
State propagate(const State& x, double dt_s);

// d propagate(x [+] dx, dt) / d dx: F_i of the paper with the measured rate and force at zero.
StateMatrix transition(const State& x, double dt_s);

// Covariance that the white noise adds over dt: Q_i.
StateMatrix process_noise(const ConstantVelocityNoise& noise, double dt_s);

}  // namespace lxd
