// SPDX-License-Identifier: Apache-2.0
// The iterated error-state Kalman filter (paper, eq. of the joint cost): prediction, and the update in information
// form.
#pragma once

#include <cmath>
#include <cstdint>
#include <span>

#include "estimator/degeneracy.hpp"
#include "estimator/imu_delay.hpp"
#include "estimator/imu_mount.hpp"
#include "estimator/imu_noise.hpp"
#include "estimator/inertial_propagation.hpp"
#include "estimator/innovation.hpp"
#include "estimator/normal_equations.hpp"
#include "estimator/propagation.hpp"
#include "estimator/state.hpp"

namespace lxd {

// The part of the state that belongs to the IMU: b_g, b_a, g.
struct Calibration {
  Eigen::Vector3d b_g = Eigen::Vector3d::Zero(), b_a = Eigen::Vector3d::Zero(), g = State{}.g;
  Eigen::Matrix<double, 9, 9> P = Eigen::Matrix<double, 9, 9>::Zero();
};

// What has no covariance is frozen: it stays what it is, through predictions and updates (b_a and g without an IMU).
class Ieskf {
 public:
  explicit Ieskf(const ImuDelay& delay = {}, const ImuMount& mount = ImuMount()) : delay_(delay), mount_(mount) {}

  void reset(const State& x, const StateMatrix& P);

  // Prior at the next sweep's end: x-check and P of the paper. At constant velocity, or along one of the IMU's
  // readings.
  void predict(double dt_s, const ConstantVelocityNoise& noise);
  void predict(const InertialSpan& measured, const ImuNoise& noise);

  // The first after a gap: predicts over gap.known_s, then holds the pose.
  void predict_across(const Gap& gap, const ConstantVelocityNoise& noise);

  // Starts the iterations at the prior.
  void begin_update();

  // One Gauss-Newton step of the MAP problem from the current iterate. Returns the increment dx that was applied.
  StateVector iterate(const NormalEquations& measured);

  // Ends the update with the covariance of the last iteration's information. False: something of the solution is not
  // finite or the information is not positive definite; the update is then abandoned.
  // skew: what the sweep's skew says of the IMU's delay; tells_mount: does the update say anything of its mount?
  [[nodiscard]] bool conclude(const DelaySums& skew = {}, bool tells_mount = false);

  // P^-1 (x [-] prior): when the iterations have come to rest, minus the rows' gradient.
  [[nodiscard]] LidarVector prior_pull() const;

  // Ends the update without a solution: state and covariance are the prediction's again.
  void abandon() { x_ = prior_; }

  // The error state that the prior expects when the block at `at` is `value`.
  [[nodiscard]] StateVector expected(StateBlock at, const Eigen::Vector3d& value) const;
  // Moves the iterations' start, not the prior.
  void start_at(const StateVector& dx) { x_ = boxplus(prior_, dx); }

  // A measurement of few dimensions, linear enough for one step: residual r = h(x) - z with the covariance R, H =
  // dh/dx. Not within an update. Dim: 1..6.
  template <int Dim>
  struct Measurement {
    Eigen::Matrix<double, Dim, 1> r;
    Eigen::Matrix<double, Dim, kStateDim> H = Eigen::Matrix<double, Dim, kStateDim>::Zero();
    Eigen::Matrix<double, Dim, Dim> R = Eigen::Matrix<double, Dim, Dim>::Zero();
  };
  // r^T (H P H^T + R)^-1 r: chi-square distributed with Dim degrees of freedom; not finite when something in it is not.
  template <int Dim>
  [[nodiscard]] double surprise(const Measurement<Dim>& measured) const;
  template <int Dim>
  void correct(const Measurement<Dim>& measured);

  // Puts other values of b_g, b_a and g, and their covariance, into the state: what they had in common with the rest of
  // it is forgotten. A block of zeros freezes.
  void replace(const Calibration& calibration);

  // L with L L^T the prior's covariance of what a sweep speaks of; of the update that has begun.
  [[nodiscard]] const LidarMatrix& prior_root() const { return prior_root_; }
  [[nodiscard]] Calibration calibration() const;

  [[nodiscard]] const State& state() const { return x_; }
  [[nodiscard]] const State& prior() const { return prior_; }
  [[nodiscard]] const StateMatrix& covariance() const { return P_; }
  // Of one axis of the block, on average.
  [[nodiscard]] double sigma(StateBlock of) const { return std::sqrt(P_.block<3, 3>(of, of).trace() / 3); }
  [[nodiscard]] const ImuDelay& delay() const { return delay_; }
  [[nodiscard]] const ImuMount& mount() const { return mount_; }
  // Of the concluded update.
  [[nodiscard]] const Innovation& innovation() const { return innovation_; }

 private:
  void propagate_covariance(const StateMatrix& F, const StateMatrix& Q);

  State x_, prior_;
  ImuDelay delay_;
  ImuMount mount_;
  Innovation innovation_;
  StateMatrix P_ = StateMatrix::Zero();
  StateVector free_ = StateVector::Ones();  // 0 where the state is frozen, since begin_update()
  StateMatrix prior_information_ = StateMatrix::Zero();
  LidarMatrix prior_root_ = LidarMatrix::Identity();
  LidarMatrix prior_lidar_information_ = LidarMatrix::Zero();  // of the marginal of what a sweep speaks of
  LidarMatrix measured_information_ = LidarMatrix::Zero();     // of the last iteration
  StateMatrix information_ = StateMatrix::Zero();              // of the last iteration, with the prior
  bool sound_ = false;                                         // every factorization since begin_update() succeeded
};

}  // namespace lxd

#include "estimator/ieskf_correct.hpp"
