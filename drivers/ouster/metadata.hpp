// SPDX-License-Identifier: Apache-2.0
// What an Ouster sensor says of itself (JSON), in both shapes: the flat one of old firmware and the one with sections.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>

#include "drivers/ouster/packet_format.hpp"
#include "rt/result.hpp"

namespace lxd {

struct OusterMetadata {
  std::string product_line;  // "OS-1-128"; empty when not said
  OusterPacketFormat format;
  std::uint16_t columns_per_frame = 0;
  double rate_hz = 0;
  std::optional<std::uint32_t> init_id;     // firmware 2.2 and later
  std::optional<std::uint64_t> serial;      // none: not said, or no number
  std::optional<std::uint16_t> lidar_port;  // UDP destination; none: not said
  std::optional<std::uint16_t> imu_port;
  std::vector<double> altitude_rad;  // per row, above the sensor's horizontal plane
  std::vector<double> azimuth_rad;   // per row, against the encoder's angle
  std::vector<int> pixel_shift;      // per row, columns; for images only, not needed for points
  Eigen::Matrix4d T_lidar_beam = Eigen::Matrix4d::Identity();    // m
  Eigen::Matrix4d T_sensor_lidar = Eigen::Matrix4d::Identity();  // m
  std::vector<std::string> notes;                                // what was left out and therefore assumed
};

// The error lists every fault found, a line each: "<file>: <path in the JSON>: <sentence>".
Result<OusterMetadata> parse_ouster_metadata(std::string_view json, const std::string& file);

}  // namespace lxd
