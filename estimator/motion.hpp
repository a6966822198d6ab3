// SPDX-License-Identifier: Apache-2.0
// What carries the state from one sweep to the next, chosen anew for every sweep by what is alive (paper,
// "Configuration-Adaptive Kinematic State Propagation"): the IMU where its readings cover the time, else constant
// velocity; the wheels' speeds correct either as they come.
//
// Without the IMU the state's b_g is minus the body's rate (state.hpp). So when the IMU falls silent its biases and
// gravity are set aside, with their covariance, and taken up again when it returns.
// Real-time thread only; memory from the arena.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "estimator/config.hpp"
#include "estimator/ieskf.hpp"
#include "estimator/imu_history.hpp"
#include "estimator/motion_source.hpp"
#include "estimator/sweep_path.hpp"
#include "estimator/wheel_alignment.hpp"
#include "estimator/wheel_history.hpp"
#include "estimator/wheel_update.hpp"
#include "rt/arena.hpp"

namespace lxd {

struct MotionSetup {
  EstimatorConfig estimator;
  std::optional<ImuNoise> imu;      // none: no IMU is in use
  std::optional<WheelModel> wheel;  // none: no wheels are
  // Attitude of the body when it begins and nothing tells what is up: the world has the axes of the rig's reference.
  Eigen::Matrix3d R_world_body = Eigen::Matrix3d::Identity();
};

class Motion {
 public:
  Motion(const MotionSetup& setup, Arena& arena);

  // In the order of time, before the prediction that needs them.
  void add(const InertialReading& reading) noexcept;
  void add(const WheelReading& reading) noexcept;

  // What is known at `to` of a body of which nothing was known at `from`: level by the mean force, turning as the
  // gyroscope says; and how sure that is. Without readings: as the setup says, turning and moving as carriers may.
  struct Beginning {
    State x;
    StateMatrix P = StateMatrix::Zero();
  };
  [[nodiscard]] Beginning begin(RigTime from, RigTime to) const noexcept;

  // The state x at constant velocity is known now, and what the IMU read over [from, to] is held against it: the
  // gyroscope's bias, gravity and their doubts. Until then the IMU propagates nothing; one that is heard later is
  // aligned when it is.
  void align(const State& x, RigTime from, RigTime to) noexcept;

  // The LiDAR holds this pose: what the wheels rolled since the last one that it held tells of their clock, how the
  // gyroscope turned of the IMU's axes.
  void align_sensors(const State& x, RigTime at, const Pose& T_world_body) noexcept;
  // It holds none now.
  void forget_path() { rolled_from_.reset(), turned_from_.reset(); }

  // Forgets the alignment, not the readings.
  void restart() noexcept;
  // Forgets the readings, too: another recording begins.
  void clear() noexcept;

  // Did a sensor measure the motion from `from` to `to`: the IMU throughout, or the wheels at some time between?
  [[nodiscard]] bool measured(RigTime from, RigTime to) const noexcept;

  // Carries the filter from `from` to `to`, and tells by what.
  MotionSource predict(Ieskf& filter, RigTime from, RigTime to) noexcept;

  // The path from `from` to `to` that ends in `end`, propagated by what the last prediction was.
  void path(const State& end, RigTime from, RigTime to, SweepPath& path) noexcept;

  // The knot of that path at `at`, exact.
  [[nodiscard]] PathKnot knot(const State& end, RigTime at, RigTime to) noexcept;

  // How far that knot may be off, [rotation, position], rad^2 and m^2, when the end is right: what nothing measured
  // from `at` on.
  [[nodiscard]] Vector6d path_variance(RigTime at, RigTime to) const noexcept;

  // How the body has turned by the gyroscope, R_then_now; nothing without readings throughout or before the bias is
  // known.
  [[nodiscard]] std::optional<Eigen::Matrix3d> turn(const State& x, RigTime then, RigTime now) noexcept;

  // Of the instant of the newest reading of the IMU that was taken; long ago without one.
  [[nodiscard]] RigTime inertial_until() const { return newest_inertial_ - imu_delay_; }
  // An instant's reading is stamped so much later; as of the last prediction.
  [[nodiscard]] Duration imu_delay() const { return imu_delay_; }
  // What the gyroscope's turns lack to the LiDAR's, over these: sums of squares. Near 1 its axes are others altogether.
  // 0: too little has been turned to say.
  [[nodiscard]] double imu_unlike() const;
  // Likewise of the wheels.
  [[nodiscard]] Duration wheel_delay() const { return wheel_.delay(); }
  [[nodiscard]] const WheelAlignment& wheel_alignment() const { return wheel_alignment_; }
  [[nodiscard]] RigTime rolled_until() const { return rolled_until_; }
  [[nodiscard]] bool inertial() const { return inertial_; }
  [[nodiscard]] MotionSource source() const { return source_; }
  [[nodiscard]] const InertialCounts& inertial_counts() const { return imu_.counts(); }
  [[nodiscard]] std::uint64_t rests() const { return rests_; }        // predictions that ended at rest
  [[nodiscard]] std::uint64_t slipping() const { return slipping_; }  // wheel readings that did not fit

 private:
  void set_imu_delay(Duration delay) noexcept;
  void align_wheels(RigTime at, const Pose& T_world_body) noexcept;
  void compare_turns(const State& x, RigTime at, const Eigen::Matrix3d& R_world_body) noexcept;
  [[nodiscard]] State steady(const State& end, RigTime to) noexcept;
  [[nodiscard]] bool imu_covers(RigTime from, RigTime to) const noexcept;
  void choose(Ieskf& filter, RigTime from, RigTime to) noexcept;
  void set_imu_aside(Ieskf& filter, RigTime at) noexcept;
  void take_imu_up(Ieskf& filter, RigTime at) noexcept;
  [[nodiscard]] bool is_still(const State& x, RigTime at) const noexcept;
  void rest(Ieskf& filter, RigTime at) noexcept;
  void advance(Ieskf& filter, RigTime from, RigTime to) noexcept;
  [[nodiscard]] Eigen::Vector3d gyro_at(RigTime t) noexcept;

  MotionSetup setup_;
  ConstantVelocityNoise noise_;
  ImuHistory imu_;
  Duration imu_delay_;
  RigTime newest_inertial_ = kNever;  // stamp
  RigTime rolled_until_ = kNever;     // the last wheel reading that fitted
  WheelHistory wheel_;
  WheelAlignment wheel_alignment_;
  Eigen::Matrix3d R_body_imu_ = Eigen::Matrix3d::Identity();  // as of the last prediction
  double lacking_rad2_ = 0, turned_rad2_ = 0;                 // sums
  struct HeldPose {
    RigTime t;
    Pose T_world_body;
  };
  std::optional<HeldPose> rolled_from_, turned_from_;  // by the LiDAR: since then wheels, IMU have been told of none
  std::optional<Calibration> aside_;                   // of the IMU, while it does not propagate
  RigTime aside_since_;
  MotionSource source_ = MotionSource::constant_velocity;
  bool begun_ = false;     // align() may be asked again
  bool inertial_ = false;  // the state's b_g is the gyroscope's bias
  std::uint64_t slipping_ = 0, rests_ = 0;
};

}  // namespace lxd
