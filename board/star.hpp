// SPDX-License-Identifier: Apache-2.0
// The extrinsics as the estimator wants them: a star around the body. The file gives them around its reference; the
// body is chosen once at start: IMU, else wheel, else camera, else the primary LiDAR.
#pragma once

#include <optional>
#include <string_view>

#include <Eigen/Core>

#include "board/rig.hpp"
#include "board/sensor_set.hpp"
#include "rt/pose.hpp"

namespace lxd {

struct Star {
  std::string_view body;           // the sensor whose frame it is: imu | wheel | camera0 | lidar0
  bool body_is_reference = false;  // by the rig file
  Pose T_body_reference;           // publishes the path of the rig file's reference whatever the body is
  Pose T_body_lidar0;
  std::optional<Pose> T_body_lidar1, T_body_camera0, T_body_imu, T_body_wheel;
  std::optional<Eigen::Vector3d> antenna_in_body_m;
};

// Of the sensors in use only; a sensor in use must be in the rig, or it is an error that names it.
Result<Star> resolve_star(const Rig& rig, const SensorSet& sensors);

// [rotation in the frame itself (right perturbation), position in world]
using PoseCovariance = Eigen::Matrix<double, 6, 6>;

// Covariance of T_world_reference = T_world_body * T_body_reference, from that of T_world_body. Both frames ride on one
// carrier: with R <- R Exp(dtheta), dtheta_reference = R_reference_body dtheta_body, and the lever arm p of the
// reference in the body moves with the body's rotation, dp_reference = dp_body - R_world_body [p]x dtheta_body.
PoseCovariance carry_covariance(const Pose& T_world_body, const Pose& T_body_reference, const PoseCovariance& of_body);

}  // namespace lxd
