// SPDX-License-Identifier: Apache-2.0
// What an IMU's samples are wrong by, in continuous time, as Kalibr and the rig file write it.
#pragma once

namespace lxd {

struct ImuNoise {
  double gyro_density;   // rad/s/sqrt(Hz)
  double accel_density;  // m/s^2/sqrt(Hz)
  double gyro_walk;      // rad/s^2/sqrt(Hz), of the bias
  double accel_walk;     // m/s^3/sqrt(Hz), of the bias
  // Of its stamps: a reading is stamped so much later than a return of the same instant; and how sure that is (0:
  // exactly).
  double delay_s = 0, delay_sigma_s = 0;
  double rotation_sigma_rad = 0;  // of its mount against the LiDAR, about an axis; 0: exactly as the rig file says
};

}  // namespace lxd
