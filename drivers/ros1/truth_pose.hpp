// SPDX-License-Identifier: Apache-2.0
// A pose with its time: geometry_msgs/PoseStamped, geometry_msgs/TransformStamped, nav_msgs/Odometry.
#pragma once

#include <Eigen/Geometry>

#include "drivers/ros1/header.hpp"

namespace lxd {

struct Ros1TruthPose {
  Ros1Header header;
  Eigen::Vector3d p = Eigen::Vector3d::Zero();  // m
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
};

Ros1Fault read_ros1_pose(Ros1Reader::Bytes message, Ros1TruthPose& out);
Ros1Fault read_ros1_transform(Ros1Reader::Bytes message, Ros1TruthPose& out);
Ros1Fault read_ros1_odometry(Ros1Reader::Bytes message, Ros1TruthPose& out);  // its twist is passed over

}  // namespace lxd
