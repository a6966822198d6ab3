// SPDX-License-Identifier: Apache-2.0
// One sample of an IMU, as every IMU driver fills it: in the sensor's frame, at an instant, with all its times.
#pragma once

#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "rt/time.hpp"

namespace lxd {

struct ImuSample {
  std::optional<std::int64_t> sensor_ns;  // the sensor's own clock and epoch; none: it sends no time
  RigTime received;                       // host's stamp of the bytes that completed it
  RigTime t;                              // of the sample, by arrival alone: never before it was sent off
  Eigen::Vector3d gyro_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_mps2 = Eigen::Vector3d::Zero();  // specific force: +g upwards at rest
};

}  // namespace lxd
