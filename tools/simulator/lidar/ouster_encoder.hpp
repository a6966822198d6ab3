// SPDX-License-Identifier: Apache-2.0
// Turns of a simulated Ouster as the datagrams that the sensor sends, by the parser's tables.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "drivers/ouster/packet_format.hpp"
#include "tools/simulator/lidar/ouster_scan.hpp"

namespace lxd::sim {

struct OusterPacketHeader {
  std::uint32_t frame_id = 0;
  std::uint32_t init_id = 0;
  std::uint64_t serial = 0;
  std::uint16_t first_column = 0;
};

// Precondition: stamps_ns holds a stamp for each column of the packet, the turn has pixels for them.
std::vector<std::uint8_t> encode_ouster_packet(const OusterPacketFormat& format, const OusterPacketHeader& header,
                                               std::span<const std::int64_t> stamps_ns, const OusterTurn& turn,
                                               const OusterScanner& scanner);

// To the format's own unit, not below one unit: zero would say that nothing came back.
std::uint64_t ouster_wire_range_mm(const OusterChannelFields& fields, double range_m);

// The sensor's calibrated reflectivity: per cent of a diffuse surface, without regard to range.
std::uint64_t ouster_wire_reflectivity(const Return& pixel);

}  // namespace lxd::sim
