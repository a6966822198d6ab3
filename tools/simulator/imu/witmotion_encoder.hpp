// SPDX-License-Identifier: Apache-2.0
// Frames as a WitMotion module sends them: a burst of time, acceleration and rate, in int16 of full scale.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/imu/witmotion_format.hpp"
#include "tools/simulator/imu/imu_errors.hpp"

namespace lxd::sim {

inline constexpr std::size_t kWitMotionBurstBytes = 3 * kWitMotionFrameBytes;

// The module's clock has milliseconds and the years 2000 to 2255.
bool is_witmotion_time(std::int64_t sensor_ns);

std::vector<std::uint8_t> encode_witmotion_time(std::int64_t sensor_ns);
std::vector<std::uint8_t> encode_witmotion_acceleration(const Eigen::Vector3d& accel_mps2, double temperature_degC);
std::vector<std::uint8_t> encode_witmotion_rate(const Eigen::Vector3d& gyro_radps);

// The three of them. Values beyond full scale saturate; what is no number (NaN) becomes the lowest.
std::vector<std::uint8_t> encode_witmotion(std::int64_t sensor_ns, const Inertial& sample);

}  // namespace lxd::sim
