// SPDX-License-Identifier: Apache-2.0
// The datagram that tells a controller where the rig is, for every reading of the IMU. 152 bytes, little-endian,
// packed:
//
//   offset  type        what
//   0       char[4]     "LXDP"
//   4       uint16      version: 1
//   6       uint16      flags: bit 0, the last sweep held the pose
//   8       uint64      count of the message, from 0; a gap is a lost one
//   16      int64       ns on the rig's clock, of the reading
//   24      int64       ns since the filter's state that the pose was carried on from
//   32      float64[3]  position of the rig file's reference frame in the odometry's world, m
//   56      float64[4]  its attitude R_world_reference, as quaternion x y z w
//   88      float64[3]  its velocity in the world, m/s
//   112     float64[3]  its rate of turn in its own axes, rad/s
//   136     float64[2]  sigma of position (m) and attitude (rad), of the filter's state, largest axis
//
// The world is that of odometry.tum: continuous, and not moved when a loop closes.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "rt/pose.hpp"
#include "rt/time.hpp"

namespace lxd {

struct PoseMessage {
  bool tracked = false;
  std::uint64_t count = 0;
  RigTime t;
  Duration reach;
  Pose T_world_reference;
  Eigen::Vector3d v_world_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d rate_radps = Eigen::Vector3d::Zero();
  double sigma_m = 0, sigma_rad = 0;
};

inline constexpr std::size_t kPoseMessageBytes = 152;
std::array<std::uint8_t, kPoseMessageBytes> encode(const PoseMessage& message) noexcept;

}  // namespace lxd
