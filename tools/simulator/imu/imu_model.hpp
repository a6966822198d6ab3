// SPDX-License-Identifier: Apache-2.0
// An IMU on the rig, sample by sample. A sample is the value at its instant, not a mean over the period before it:
// whoever integrates samples as points of a curve (trapezoid or better) gets the motion back.
#pragma once

#include <cstdint>
#include <string_view>

#include "tools/simulator/imu/imu_errors.hpp"
#include "tools/simulator/motion/trajectory.hpp"

namespace lxd::sim {

struct ImuModelSample {
  double t_s = 0;  // true time since the recording's start
  Inertial truth;
  Inertial measured;
  Inertial bias;  // part of measured
};

// Rate and specific force at a sensor that sits off the body's origin.
Inertial true_inertial(const Trajectory& motion, const Pose& T_body_sensor, double t_s);

class ImuModel {
 public:
  // `stream` names the sensor ("imu", "lidar0.imu"): each draws chances of its own. Keeps a reference to the motion.
  ImuModel(const ImuConfig& config, const Trajectory& motion, std::uint64_t seed, std::string_view stream);

  // Sample k = 0, 1, ... at t_s = k sample_period_s().
  ImuModelSample next();

 private:
  const Trajectory& motion_;
  Pose T_body_sensor_;
  double period_s_;
  std::uint64_t samples_ = 0;
  ImuErrors errors_;
};

}  // namespace lxd::sim
