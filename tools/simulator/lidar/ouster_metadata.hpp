// SPDX-License-Identifier: Apache-2.0
// What a simulated Ouster says of itself: the calibration of its beams and the metadata JSON of current firmware.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "drivers/ouster/metadata.hpp"
#include "rt/pose.hpp"
#include "tools/simulator/lidar/ouster_config.hpp"

namespace lxd::sim {

inline constexpr std::uint32_t kOusterColumnsPerPacket = 16;
inline constexpr std::uint32_t kOusterImuRecords = 8, kOusterImuPacketsPerTurn = 8;

// Of one sensor: drawn from the recording's seed, as a factory's tolerances are.
struct OusterUnit {
  std::vector<double> altitude_deg, azimuth_deg;  // per row, from the top; two decimals, as in a real file
  std::uint64_t serial = 0;                       // 40 bits
};

// `number` 0 is the sensor itself, 1 the one that the serial fault puts in its place.
OusterUnit ouster_unit(const OusterConfig& config, std::uint64_t seed, std::uint64_t number = 0);
// 24 bits, never zero; `boot` counts restarts.
std::uint32_t ouster_init_id(const OusterConfig& config, std::uint64_t seed, std::uint32_t boot);

// The file's content, and the same read back by the product's own parser. Fails only when the configuration is not one
// that read_keys accepts.
std::string ouster_metadata_json(const OusterConfig& config, std::uint64_t seed);
Result<OusterMetadata> ouster_metadata(const OusterConfig& config, std::uint64_t seed);

// Lowest and highest beam.
std::pair<double, double> ouster_fov_deg(const OusterConfig& config, std::uint64_t seed);

// Where the sensor's IMU sits; its axes are the sensor's.
Pose ouster_T_sensor_imu(const OusterConfig& config);

}  // namespace lxd::sim
