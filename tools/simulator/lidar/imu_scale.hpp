// SPDX-License-Identifier: Apache-2.0
// The errors of a LiDAR's own IMU, all of them larger or smaller by one number.
#pragma once

#include "tools/simulator/imu/imu_config.hpp"

namespace lxd::sim {

inline ImuConfig scaled_errors(ImuConfig imu, double scale) {
  if (scale == 0) return without_errors(imu);
  for (double* const error : {&imu.gyroscope_noise_density, &imu.accelerometer_noise_density,
                              &imu.gyroscope_random_walk, &imu.accelerometer_random_walk, &imu.gyro_bias_radps,
                              &imu.accel_bias_mps2, &imu.gyro_scale_ppm, &imu.accel_scale_ppm, &imu.misalignment_rad}) {
    *error *= scale;
  }
  return imu;
}

}  // namespace lxd::sim
