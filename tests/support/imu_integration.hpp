// SPDX-License-Identifier: Apache-2.0
// Dead reckoning by IMU samples, to see whether they say the same as the motion they were taken from.
#pragma once

#include <array>
#include <span>

#include <Eigen/Geometry>

#include "tools/simulator/context.hpp"
#include "tools/simulator/imu/imu_errors.hpp"

namespace lxd::test {

struct DeadReckoning {
  Eigen::Quaterniond q_world_sensor = Eigen::Quaterniond::Identity();
  Eigen::Vector3d p_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_mps = Eigen::Vector3d::Zero();
};

// What the motion says of a sensor of the rig.
inline DeadReckoning true_sensor_state(const sim::Trajectory& motion, const Pose& T_body_sensor, double t_s) {
  const sim::MotionState state = motion.at(t_s);
  const Eigen::Vector3d v = state.v_world_mps + state.T_world_body.R * state.omega_body_radps.cross(T_body_sensor.p);
  const Pose T_world_sensor = state.T_world_body * T_body_sensor;
  return {T_world_sensor.quaternion(), T_world_sensor.p, v};
}

// The state's rate of change under one sample, added to `state` for h seconds.
inline DeadReckoning advanced(const DeadReckoning& state, const DeadReckoning& rate_at, const sim::Inertial& sample,
                              double h_s) {
  const Eigen::Vector3d w = 0.5 * h_s * sample.gyro_radps;
  const Eigen::Quaterniond turn = rate_at.q_world_sensor * Eigen::Quaterniond(0, w.x(), w.y(), w.z());
  DeadReckoning next = state;
  next.q_world_sensor.coeffs() += turn.coeffs();
  next.p_m += h_s * rate_at.v_mps;
  const Eigen::Vector3d gravity{0, 0, -sim::kGravity_mps2};
  next.v_mps += h_s * (rate_at.q_world_sensor.normalized() * sample.accel_mps2 + gravity);
  return next;
}

// One Runge-Kutta step of fourth order over two periods: three samples are its begin, middle and end.
inline DeadReckoning integrated(const DeadReckoning& state, std::span<const sim::Inertial, 3> samples,
                                double period_s) {
  const DeadReckoning at_2 = advanced(state, state, samples[0], period_s);
  const DeadReckoning at_3 = advanced(state, at_2, samples[1], period_s);
  const DeadReckoning at_4 = advanced(state, at_3, samples[1], 2 * period_s);
  DeadReckoning next = advanced(state, state, samples[0], period_s / 3);
  next = advanced(next, at_2, samples[1], 2 * period_s / 3);
  next = advanced(next, at_3, samples[1], 2 * period_s / 3);
  next = advanced(next, at_4, samples[2], period_s / 3);
  next.q_world_sensor.normalize();
  return next;
}

}  // namespace lxd::test
