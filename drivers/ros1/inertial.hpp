// SPDX-License-Identifier: Apache-2.0
// sensor_msgs/Imu: rates and specific force; its orientation and covariances are passed over.
#pragma once

#include <Eigen/Core>

#include "drivers/ros1/header.hpp"

namespace lxd {

struct Ros1Inertial {
  Ros1Header header;
  Eigen::Vector3d gyro_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_mps2 = Eigen::Vector3d::Zero();
};

// `out` has a meaning only when there is no fault; so with all messages.
Ros1Fault read_ros1_inertial(Ros1Reader::Bytes message, Ros1Inertial& out);

}  // namespace lxd
