// SPDX-License-Identifier: Apache-2.0
// How the IMU is turned on its carrier against what the rig file says of it and the LiDAR. The body stays where the rig
// file has it against the LiDAR; it is the readings that are turned. Estimated beside the filter as the IMU's delay is
// (imu_delay.hpp), with three numbers instead of one. README.md, "The IMU's mount". Real-time thread.
#pragma once

#include "estimator/imu_delay.hpp"

namespace lxd {

class ImuMount {
 public:
  using ByTurn = Eigen::Matrix<double, kStateDim, 3>;

  // How sure the rig file is, about each axis; 0: exactly.
  explicit ImuMount(double sigma_rad = 0) : P_(sigma_rad * sigma_rad * Eigen::Matrix3d::Identity()) {}

  void forget() { by_turn_.setZero(), rate_sum_.setZero(), span_s_ = 0; }
  // The state was carried on with this transition, by readings as they are turned now.
  void predict(const StateMatrix& F, const InertialSpan& measured);
  // The state was corrected by something else.
  void correct(const StateMatrix& keep) { by_turn_ = (keep * by_turn_).eval(); }
  // telling: false when nothing can be learnt from this one. The correction that the state needs for what was learnt.
  StateVector update(const UpdateRecord& update, bool telling);

  [[nodiscard]] bool known() const { return !(P_(0, 0) > 0); }
  // Takes readings into the body's axes: near the identity.
  [[nodiscard]] const Eigen::Matrix3d& R_body_imu() const { return R_body_imu_; }
  [[nodiscard]] Eigen::Vector3d turned_rad() const { return Log(R_body_imu_); }
  [[nodiscard]] const Eigen::Matrix3d& covariance_rad2() const { return P_; }  // of that, about the body's axes
  // d (true state [-] state) / d turn, of what the mount is wrong by: R_true = Exp(turn) R_body_imu.
  [[nodiscard]] const ByTurn& state_by_turn() const { return by_turn_; }

 private:
  Eigen::Matrix3d R_body_imu_ = Eigen::Matrix3d::Identity(), P_;
  ByTurn by_turn_ = ByTurn::Zero();
  Eigen::Vector3d rate_sum_ = Eigen::Vector3d::Zero();  // of the readings since the last update, times their spans
  double span_s_ = 0;
};

}  // namespace lxd
