// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/imu/imu_model.hpp"

#include "tools/simulator/context.hpp"

namespace lxd::sim {

// With r = p_body_sensor: a_sensor = a_body + alpha x r + omega x (omega x r), and an accelerometer senses a - g.
Inertial true_inertial(const Trajectory& motion, const Pose& T_body_sensor, double t_s) {
  const MotionState state = motion.at(t_s);
  const Eigen::Vector3d g_world{0, 0, -kGravity_mps2};
  const Eigen::Vector3d& omega = state.omega_body_radps;
  const Eigen::Vector3d& r = T_body_sensor.p;
  const Eigen::Vector3d lever = state.alpha_body_radps2.cross(r) + omega.cross(omega.cross(r));
  const Eigen::Vector3d force = state.T_world_body.R.transpose() * (state.a_world_mps2 - g_world) + lever;
  return {T_body_sensor.R.transpose() * omega, T_body_sensor.R.transpose() * force};
}

ImuModel::ImuModel(const ImuConfig& config, const Trajectory& motion, std::uint64_t seed, std::string_view stream)
    : motion_(motion),
      T_body_sensor_(config.T_body_sensor),
      period_s_(sample_period_s(config)),
      errors_(config, seed, stream) {}

ImuModelSample ImuModel::next() {
  const double t_s = static_cast<double>(samples_++) * period_s_;
  const Inertial truth = true_inertial(motion_, T_body_sensor_, t_s);
  const Inertial bias = errors_.bias();
  return {t_s, truth, errors_.measured(truth, t_s), bias};
}

}  // namespace lxd::sim
