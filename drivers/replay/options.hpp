// SPDX-License-Identifier: Apache-2.0
// What a user may choose about the reading of a recording.
#pragma once

#include <numbers>

namespace lxd {

// KITTI's HDL-64E intrinsics read every elevation too low by this much. Found by Deschaud, "IMLS-SLAM: scan-to-model
// matching based on 3D data", ICRA 2018 (section V), and applied by CT-ICP and KISS-ICP since.
inline constexpr double kKittiVerticalAngleCorrection_rad = 0.205 * std::numbers::pi / 180;

// Of a rig recording: the sensors whose clocks are at whole seconds with the pulses of pps.csv.
struct PulsedSensors {
  bool lidar0 = false, lidar1 = false, imu = false;
};

struct ReplayOptions {
  PulsedSensors pulsed{};
  // Added to the elevation of each point of a KITTI raw drive, and of an odometry sequence that has KITTI's calib.txt;
  // 0: points as they are in the file.
  double kitti_vertical_angle_correction_rad = 0;
};

}  // namespace lxd
