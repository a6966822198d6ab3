// SPDX-License-Identifier: Apache-2.0
// Frames as a VectorNav sends them.
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/imu/vectornav_format.hpp"
#include "tools/simulator/imu/imu_errors.hpp"

namespace lxd::sim {

// Time since start-up and uncompensated rate and acceleration: 38 bytes.
VectorNavLayout vectornav_layout();

// One frame with the fields of the layout. Times, rates and accelerations are the sample's; other fields are 0.
std::vector<std::uint8_t> encode_vectornav(const VectorNavLayout& layout, std::int64_t sensor_ns,
                                           const Inertial& sample);

}  // namespace lxd::sim
