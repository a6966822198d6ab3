// SPDX-License-Identifier: Apache-2.0
// Points and inertial samples as Livox SDK2 datagrams, by the parser's tables.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "drivers/livox/packet_parser.hpp"
#include "tools/simulator/lidar/livox_scan.hpp"

namespace lxd::sim {

struct LivoxHeader {
  std::uint64_t timestamp_ns = 0;
  std::uint32_t duration_ns = 0;  // from the first point to the next packet's
  std::uint16_t packet_counter = 0;
  std::uint8_t frame_counter = 0;
  LivoxClock clock = LivoxClock::kUptime;
};

// Cartesian records only. No shots: a packet that says that it has no point.
std::vector<std::uint8_t> encode_livox_points(const LivoxRecord& record, const LivoxHeader& header,
                                              std::span<const LivoxReturn> shots);

std::vector<std::uint8_t> encode_livox_imu(const LivoxHeader& header, const Eigen::Vector3d& gyro_radps,
                                           const Eigen::Vector3d& accel_mps2);

}  // namespace lxd::sim
