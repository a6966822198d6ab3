// SPDX-License-Identifier: Apache-2.0
// An OS1-128 of 1024 columns at 20 Hz, for benchmarks: its metadata and packets of any profile.
#pragma once

#include <vector>

#include "drivers/crc.hpp"
#include "drivers/ouster/metadata.hpp"

namespace lxd::bench {

inline constexpr std::uint16_t kColumns = 1024, kRows = 128, kColumnsPerPacket = 16;
inline constexpr double kRate_hz = 20;

inline OusterMetadata os1_128(const char* profile) {
  OusterMetadata metadata;
  metadata.format = {find_ouster_profile(profile), kColumnsPerPacket, kRows};
  metadata.columns_per_frame = kColumns;
  metadata.rate_hz = kRate_hz;
  for (int row = 0; row < kRows; ++row) {
    metadata.altitude_rad.push_back(0.39 - 0.78 * row / (kRows - 1));
    metadata.azimuth_rad.push_back(0.01 * (row % 4));
  }
  return metadata;
}

inline std::vector<std::uint8_t> packet_of(const OusterPacketFormat& format, std::uint32_t frame_id,
                                           std::uint16_t first) {
  constexpr std::uint64_t kTurn_ns = 50'000'000;
  const OusterFraming& framing = format.framing();
  std::vector<std::uint8_t> packet(format.packet_bytes());
  framing.packet_type.set(packet.data(), kOusterLidarPacket);
  framing.packet_frame_id.set(packet.data(), frame_id);
  for (std::uint16_t c = 0; c < kColumnsPerPacket; ++c) {
    std::uint8_t* const column = packet.data() + format.column_offset(c);
    const unsigned id = first + c;
    framing.timestamp_ns.set(column, frame_id * kTurn_ns + id * kTurn_ns / kColumns);
    framing.measurement_id.set(column, id);
    framing.column_frame_id.set(column, frame_id);
    framing.header_status.set(column, 1);
    framing.footer_status.set(column + format.column_bytes() - framing.column_footer_bytes, ~0U);
    for (unsigned row = 0; row < kRows; ++row) {
      std::uint8_t* const block = column + framing.column_header_bytes + row * format.profile->channel_bytes;
      format.profile->fields.range_mm.set(block, 1000 + 40 * row + id);
      format.profile->fields.reflectivity.set(block, row);
      format.profile->fields.range2_mm.set(block, row % 4 == 0 ? 9000 + id : 0);
    }
  }
  if (framing.crc.present()) {
    const auto sealed = std::span(packet).first(packet.size() - 8);
    framing.crc.set(packet.data() + format.footer_offset(), crc64(sealed));
  }
  return packet;
}

// So many turns that the first after the last one is no packet that comes late.
inline std::vector<std::vector<std::uint8_t>> turns_of(const OusterPacketFormat& format) {
  constexpr std::uint32_t kTurns = 16;
  std::vector<std::vector<std::uint8_t>> packets;
  for (std::uint32_t frame = 1; frame <= kTurns; ++frame) {
    for (std::uint16_t first = 0; first < kColumns; first += kColumnsPerPacket)
      packets.push_back(packet_of(format, frame, first));
  }
  return packets;
}

inline constexpr double kPacketsPerSecond = kRate_hz * kColumns / kColumnsPerPacket;

}  // namespace lxd::bench
