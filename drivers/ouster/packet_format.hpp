// SPDX-License-Identifier: Apache-2.0
// The shape of an Ouster LiDAR datagram: header, columns of channel blocks, footer. All of it is tables; the parser
// only follows them. Source: ouster-sdk 46b7bcee, ouster_core/src/parsing.cpp; checked against captures (see README).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "drivers/ouster/bit_field.hpp"

namespace lxd {

// Header, column and footer of one family of profiles; fields count from the start of the part they belong to.
struct OusterFraming {
  std::size_t packet_header_bytes = 0, column_header_bytes = 0, column_footer_bytes = 0, packet_footer_bytes = 0;
  BitField packet_type{}, packet_frame_id{}, init_id{}, serial{};  // packet header; absent in LEGACY
  BitField timestamp_ns{}, measurement_id{}, column_frame_id{};    // column header; the frame id in LEGACY only
  BitField header_status{}, footer_status{};                       // one of the two; bit 0: the column is valid
  BitField crc{};                                                  // packet footer
  int frame_id_bits = 16;                                          // the counter's width, for its wrap
};

// One channel block (a pixel): ranges in mm, the rest in the sensor's own scale.
struct OusterChannelFields {
  BitField range_mm{}, flags{}, reflectivity{}, signal{}, near_ir{};
  BitField range2_mm{}, flags2{}, reflectivity2{}, signal2{}, window{};
};

struct OusterProfile {
  std::string_view name;  // as the metadata writes it
  const OusterFraming* framing = nullptr;
  std::size_t channel_bytes = 0;
  OusterChannelFields fields{};
};

// Null when the profile is not one we know.
const OusterProfile* find_ouster_profile(std::string_view name);
std::span<const OusterProfile> ouster_profiles();

inline constexpr std::uint64_t kOusterLidarPacket = 1;           // packet type
inline constexpr std::uint16_t kOusterMaxColumnsPerPacket = 64;  // every sample has 16
inline constexpr std::size_t kOusterMaxPacketBytes = 65535;      // the SDK's limit too

// A profile with the counts that the metadata adds. Precondition: profile is not null.
struct OusterPacketFormat {
  const OusterProfile* profile = nullptr;
  std::uint16_t columns_per_packet = 0;
  std::uint16_t pixels_per_column = 0;

  [[nodiscard]] const OusterFraming& framing() const { return *profile->framing; }
  [[nodiscard]] std::size_t column_bytes() const {
    return framing().column_header_bytes + pixels_per_column * profile->channel_bytes + framing().column_footer_bytes;
  }
  [[nodiscard]] std::size_t packet_bytes() const {
    return framing().packet_header_bytes + columns_per_packet * column_bytes() + framing().packet_footer_bytes;
  }
  [[nodiscard]] std::size_t column_offset(std::size_t column) const {
    return framing().packet_header_bytes + column * column_bytes();
  }
  [[nodiscard]] std::size_t footer_offset() const { return column_offset(columns_per_packet); }
};

}  // namespace lxd
