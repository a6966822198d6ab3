// SPDX-License-Identifier: Apache-2.0
// The tables themselves.
#include "drivers/ouster/packet_format.hpp"

#include <array>

namespace lxd {
namespace {

constexpr OusterFraming kLegacyFraming{.column_header_bytes = 16,
                                       .column_footer_bytes = 4,
                                       .timestamp_ns = bytes_at(0, 8),
                                       .measurement_id = bytes_at(8, 2),
                                       .column_frame_id = bytes_at(10, 2),
                                       .footer_status = bytes_at(0, 4)};

constexpr OusterFraming kStandardFraming{.packet_header_bytes = 32,
                                         .column_header_bytes = 12,
                                         .packet_footer_bytes = 32,
                                         .packet_type = bytes_at(0, 2),
                                         .packet_frame_id = bytes_at(2, 2),
                                         .init_id = bytes_at(4, 3),
                                         .serial = bytes_at(7, 5),
                                         .timestamp_ns = bytes_at(0, 8),
                                         .measurement_id = bytes_at(8, 2),
                                         .header_status = bytes_at(10, 2),
                                         .crc = bytes_at(24, 8)};

constexpr OusterFraming kFusaFraming{.packet_header_bytes = 32,
                                     .column_header_bytes = 12,
                                     .packet_footer_bytes = 32,
                                     .packet_type = bytes_at(0, 1),
                                     .packet_frame_id = bytes_at(4, 4),
                                     .init_id = bytes_at(1, 3),
                                     .serial = bytes_at(11, 5),
                                     .timestamp_ns = bytes_at(0, 8),
                                     .measurement_id = bytes_at(8, 2),
                                     .header_status = bytes_at(10, 2),
                                     .frame_id_bits = 32};

// {first bit, width, scale as a power of two}
constexpr OusterChannelFields kLegacyFields{
    .range_mm = {0, 20}, .flags = {28, 4}, .reflectivity = {32, 8}, .signal = {48, 16}, .near_ir = {64, 16}};

constexpr OusterChannelFields kSingleFields{.range_mm = {0, 19},
                                            .flags = {19, 5},
                                            .reflectivity = {32, 8},
                                            .signal = {48, 16},
                                            .near_ir = {64, 16},
                                            .window = {88, 8}};

constexpr OusterChannelFields kDualFields{.range_mm = {0, 19},
                                          .flags = {19, 5},
                                          .reflectivity = {24, 8},
                                          .signal = {64, 16},
                                          .near_ir = {96, 16},
                                          .range2_mm = {32, 19},
                                          .flags2 = {51, 5},
                                          .reflectivity2 = {56, 8},
                                          .signal2 = {80, 16},
                                          .window = {120, 8}};

constexpr OusterChannelFields kLowBandwidthFields{
    .range_mm = {0, 15, 3}, .flags = {15, 1}, .reflectivity = {16, 8}, .near_ir = {24, 8, 4}};

constexpr OusterChannelFields kLowBandwidthDualFields{.range_mm = {0, 15, 3},
                                                      .flags = {15, 1},
                                                      .reflectivity = {16, 8},
                                                      .near_ir = {24, 8, 4},
                                                      .range2_mm = {32, 15, 3},
                                                      .flags2 = {47, 1},
                                                      .reflectivity2 = {48, 8},
                                                      .window = {56, 8}};

constexpr std::array kProfiles{
    OusterProfile{"LEGACY", &kLegacyFraming, 12, kLegacyFields},
    OusterProfile{"RNG19_RFL8_SIG16_NIR16", &kStandardFraming, 12, kSingleFields},
    OusterProfile{"RNG19_RFL8_SIG16_NIR16_DUAL", &kStandardFraming, 16, kDualFields},
    OusterProfile{"RNG15_RFL8_NIR8", &kStandardFraming, 4, kLowBandwidthFields},
    OusterProfile{"RNG15_RFL8_NIR8_DUAL", &kStandardFraming, 8, kLowBandwidthDualFields},
    OusterProfile{"FUSA_RNG15_RFL8_NIR8_DUAL", &kFusaFraming, 8, kLowBandwidthDualFields},
    OusterProfile{"FIVE_WORD_PIXEL", &kStandardFraming, 20, kDualFields},  // a word more, of no use here
};

}  // namespace

std::span<const OusterProfile> ouster_profiles() { return kProfiles; }

const OusterProfile* find_ouster_profile(std::string_view name) {
  for (const OusterProfile& profile : kProfiles) {
    if (profile.name == name) return &profile;
  }
  return nullptr;
}

}  // namespace lxd
