// SPDX-License-Identifier: Apache-2.0
// Inertial samples as an Ouster's own packets of either profile, by the parser's tables.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "drivers/ouster/imu_parser.hpp"

namespace lxd::sim {

struct OusterImuHeader {
  std::uint32_t frame_id = 0;
  std::uint32_t init_id = 0;
  std::uint64_t serial = 0;
  std::uint64_t system_ns = 0;
  std::uint16_t first_measurement_id = 0;  // the column of points that is fired at the time
  std::uint16_t measurement_step = 1;
};

// The serial number, the NMEA text and what else a profile does not have is left out; the text is empty.
std::vector<std::uint8_t> encode_ouster_imu(const OusterImuProfile& profile, const OusterImuHeader& header,
                                            std::span<const OusterImuSample> samples);

}  // namespace lxd::sim
