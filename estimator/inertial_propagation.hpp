// SPDX-License-Identifier: Apache-2.0
// Propagation by an IMU (paper, "IMU-Driven Inertial Propagation"): state, transition and noise over a span in which
// the measured rate and force are constant.
//
// The paper holds the attitude of the span's begin for the whole of it. Here the force turns with the body: velocity
// sees it at the mean time of the span, position (which weighs early force more) at the first third. Both are exact to
// the third order of the span; estimator/README.md derives them.
#pragma once

#include "estimator/imu_noise.hpp"
#include "estimator/state.hpp"

namespace lxd {

// Rate and specific force of the body, constant over the span; with the IMU's biases in them. And by how much they
// changed from its begin to its end, which the propagation leaves out.
struct InertialSpan {
  double span_s;
  Eigen::Vector3d rate_radps;
  Eigen::Vector3d force_mps2;
  Eigen::Vector3d rate_change_radps = Eigen::Vector3d::Zero(), force_change_mps2 = Eigen::Vector3d::Zero();
};

State propagate(const State& x, const InertialSpan& measured);

// d propagate(x [+] dx) / d dx: F_i of the paper, derived for the discrete step above.
StateMatrix transition(const State& x, const InertialSpan& measured);

// Covariance that the samples' white noise and the walk of the biases add: Q_i of the paper.
StateMatrix process_noise(const ImuNoise& noise, double span_s);

}  // namespace lxd
