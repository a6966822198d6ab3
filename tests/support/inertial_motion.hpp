// SPDX-License-Identifier: Apache-2.0
// Smooth motions of a body, and what its IMU and its wheels say of them.
#pragma once

#include <cmath>
#include <functional>
#include <utility>

#include "estimator/imu_history.hpp"
#include "estimator/state.hpp"
#include "estimator/wheel_update.hpp"

namespace lxd::test {

inline constexpr double kStandardGravity_mps2 = 9.80665;
inline const Eigen::Vector3d kGravity_mps2{0, 0, -kStandardGravity_mps2};

// A motion given by its pose; rates and accelerations are its central differences, right to 1e-7.
class InertialMotion {
 public:
  using PoseAt = std::function<Pose(double)>;
  explicit InertialMotion(PoseAt pose) : pose_(std::move(pose)) {}

  [[nodiscard]] Pose pose(double t_s) const { return pose_(t_s); }
  [[nodiscard]] Eigen::Vector3d velocity(double t_s) const {
    return (pose_(t_s + kStep_s).p - pose_(t_s - kStep_s).p) / (2 * kStep_s);
  }
  [[nodiscard]] Eigen::Vector3d rate(double t_s) const {
    return Log(pose_(t_s - kStep_s).R.transpose() * pose_(t_s + kStep_s).R) / (2 * kStep_s);
  }
  [[nodiscard]] Eigen::Vector3d force(double t_s) const {
    const Eigen::Vector3d a =
        (pose_(t_s + kStep_s).p - 2 * pose_(t_s).p + pose_(t_s - kStep_s).p) / (kStep_s * kStep_s);
    return pose_(t_s).R.transpose() * (a - kGravity_mps2);
  }
  // b_g: minus the rate, as without an IMU.
  [[nodiscard]] State state(double t_s) const {
    State x;
    x.R = pose_(t_s).R;
    x.p = pose_(t_s).p;
    x.v = velocity(t_s);
    x.b_g = -rate(t_s);
    x.g = kGravity_mps2;
    return x;
  }
  [[nodiscard]] InertialReading reading(double t_s) const {
    return {RigTime::from_seconds(t_s), rate(t_s), force(t_s)};
  }
  // Of wheels whose frame is the body's.
  [[nodiscard]] WheelReading wheel(double t_s) const {
    return {RigTime::from_seconds(t_s), (pose_(t_s).R.transpose() * velocity(t_s)).x(), rate(t_s).z()};
  }

 private:
  static constexpr double kStep_s = 3e-4;
  PoseAt pose_;
};

inline Eigen::Matrix3d turned(double yaw, double pitch, double roll) {
  return Exp(Eigen::Vector3d(0, 0, yaw)) * Exp(Eigen::Vector3d(0, pitch, 0)) * Exp(Eigen::Vector3d(roll, 0, 0));
}

inline InertialMotion resting(const Eigen::Matrix3d& R = Eigen::Matrix3d::Identity()) {
  return InertialMotion([R](double) { return Pose{R, Eigen::Vector3d::Zero()}; });
}

// Straight on and turning about its own z, seen from t_s = 0.
inline InertialMotion steady(const Eigen::Vector3d& v_mps, double yaw_rate_radps) {
  return InertialMotion([=](double t_s) { return Pose{turned(yaw_rate_radps * t_s, 0, 0), v_mps * t_s}; });
}

// Time since 1 s, eased in from rest over half a second.
inline double eased_s(double t_s) {
  constexpr double kRamp_s = 0.5;
  const double since = std::max(0.0, t_s - 1);
  return std::sqrt(since * since + kRamp_s * kRamp_s) - kRamp_s;
}

// Someone who walks about a room, looks around with up to 2 rad/s and steps at 2 Hz; begins at rest at 1 s.
inline InertialMotion walking_about() {
  return InertialMotion([](double t_s) {
    const double s = eased_s(t_s), ease = s / (s + 0.5), step = 4 * M_PI * s;
    return Pose{turned(1.6 * std::sin(1.25 * s), 0.04 * ease * std::sin(step), 0.05 * ease * std::sin(0.5 * step)),
                {1.2 * std::sin(0.6 * s), 0.8 - 0.8 * std::cos(0.5 * s), 0.02 * ease * std::sin(step)}};
  });
}

// A robot that only ever drives along its own x, in a circle with 1 m/s and 0.8 rad/s; begins at rest at 1 s.
inline InertialMotion driving_about() {
  return InertialMotion([](double t_s) {
    const double angle = 0.8 * eased_s(t_s);
    return Pose{turned(angle, 0, 0), {1.25 * std::sin(angle), 1.25 - 1.25 * std::cos(angle), 0}};
  });
}

}  // namespace lxd::test
