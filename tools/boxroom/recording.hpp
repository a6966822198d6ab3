// SPDX-License-Identifier: Apache-2.0
// Writes an exact recording of the hall with boxes, in the two layouts that other programs read.
#pragma once

#include <cstdint>
#include <filesystem>

#include "rt/result.hpp"

namespace lxd::boxroom {

struct Options {
  std::filesystem::path out;
  std::uint32_t seed = 1;    // of the world and of the noise
  double angular_speed = 1;  // times the standard motion's
  int sweeps = 100;          // 10 a second
  int beams = 32;            // at least 2
  double rest_s = 1;         // at rest before the motion begins
};

// out/moving   generic folder: lidar0/ (every point fired at its own time), imu.csv, rig.yaml, truth.tum of the body
// out/frozen   KITTI odometry: velodyne/ (as if the LiDAR stood still during each sweep), times.txt, poses.txt,
//              truth.tum of the LiDAR
// out/world.ply  the true surfaces of both, in truth's frame
// An Error names the first file that could not be written.
Status write_recording(const Options& options);

}  // namespace lxd::boxroom
