// SPDX-License-Identifier: Apache-2.0
// The iterated error-state Kalman filter (paper, eq. of the joint cost): prediction, and the update in information
// form.
#pragma once

#include <cstdint>

#include "estimator/degeneracy.hpp"
#include "estimator/innovation.hpp"
#include "estimator/normal_equations.hpp"
#include "estimator/propagation.hpp"
#include "estimator/state.hpp"

namespace lxd {

// Which blocks of the state are estimated; the others are frozen: their covariance is zero and stays zero.
inline constexpr int kActiveDim = kLidarDim;  // the configuration without an IMU

class Ieskf {
 public:
  void reset(const State& x, const StateMatrix& P);

  // Prior at the next sweep's end: x-check and P of the paper.
  void predict(double dt_s, const ConstantVelocityNoise& noise);

  // The same after a gap: predicts over gap.known_s, then holds the pose.
  void predict_across(const Gap& gap, const ConstantVelocityNoise& noise);

  // Starts the iterations at the prior.
  void begin_update();

  // One Gauss-Newton step of the MAP problem from the current iterate. Returns the increment dx that was applied.
  StateVector iterate(const NormalEquations& measured);

  // Ends the update with the covariance of the last iteration's information. False: something of the solution is not
  // finite or the information is not positive definite; the update is then abandoned.
  [[nodiscard]] bool conclude();

  // Ends the update without a solution: state and covariance are the prediction's again.
  void abandon() { x_ = prior_; }

  // The error state that the prior expects when the block at `at` is `value`.
  [[nodiscard]] StateVector expected(StateBlock at, const Eigen::Vector3d& value) const;
  // Moves the iterations' start, not the prior.
  void start_at(const StateVector& dx) { x_ = boxplus(prior_, dx); }

  [[nodiscard]] const State& state() const { return x_; }
  [[nodiscard]] const State& prior() const { return prior_; }
  [[nodiscard]] const StateMatrix& covariance() const { return P_; }
  // Of the concluded update.
  [[nodiscard]] Innovation innovation() const;

 private:
  using ActiveMatrix = Eigen::Matrix<double, kActiveDim, kActiveDim>;

  State x_, prior_;
  StateMatrix P_ = StateMatrix::Zero();
  ActiveMatrix prior_information_ = ActiveMatrix::Zero();
  ActiveMatrix measured_information_ = ActiveMatrix::Zero();  // of the last iteration
  ActiveMatrix information_ = ActiveMatrix::Zero();           // of the last iteration, with the prior
  bool sound_ = false;                                        // every factorization since begin_update() succeeded
};

}  // namespace lxd
