// SPDX-License-Identifier: Apache-2.0
// The shape of an Ouster sensor's inertial datagrams, as tables that the parser follows and the simulator fills.
// Source: ouster-sdk 46b7bcee, ouster_core/src/parsing.cpp; checked against captures of both profiles.
#pragma once

#include <cstddef>
#include <cstdint>

#include "drivers/ouster/bit_field.hpp"

namespace lxd {

// Three floats each, x y z one after the other; offsets count from the record's first byte.
struct OusterImuRecord {
  std::size_t bytes = 0;
  BitField accel_ns{}, gyro_ns{};       // sensor time of each reading
  BitField measurement_id{}, status{};  // absent in LEGACY; status bit 0: valid
  int accel_at = 0, gyro_at = 0;        // first byte of the floats
  double accel_unit_mps2 = 1, gyro_unit_radps = 1;
};

struct OusterImuProfile {
  std::size_t header_bytes = 0, footer_bytes = 0;
  std::size_t fixed_records = 0;  // 0: as many as fit between header and footer
  BitField packet_type{}, frame_id{}, init_id{}, serial{};
  BitField system_ns{};  // when the packet was made
  BitField crc{};        // in the footer
  OusterImuRecord record{};
};

inline constexpr std::size_t kOusterImuTextBytes = 92;  // NMEA sentences, NUL padded, behind their time
inline constexpr std::size_t kOusterImuMaxRecords = 64;
inline constexpr std::uint64_t kOusterImuPacket = 2;  // packet type

inline constexpr double kOusterGravity_mps2 = 9.80665;
inline constexpr double kOusterRadPerDeg = 0.017453292519943295;

// No header: one record of 48 bytes, in g and degrees a second.
inline constexpr OusterImuProfile kOusterLegacyImu{.fixed_records = 1,
                                                   .system_ns = bytes_at(0, 8),
                                                   .record = {.bytes = 48,
                                                              .accel_ns = bytes_at(8, 8),
                                                              .gyro_ns = bytes_at(16, 8),
                                                              .accel_at = 24,
                                                              .gyro_at = 36,
                                                              .accel_unit_mps2 = kOusterGravity_mps2,
                                                              .gyro_unit_radps = kOusterRadPerDeg}};

// ACCEL32_GYRO32_NMEA: header, time and text of NMEA, records in SI units, footer.
inline constexpr OusterImuProfile kOusterAccelGyroNmea{.header_bytes = 132,
                                                       .footer_bytes = 32,
                                                       .packet_type = bytes_at(0, 2),
                                                       .frame_id = bytes_at(2, 2),
                                                       .init_id = bytes_at(4, 3),
                                                       .serial = bytes_at(7, 5),
                                                       .system_ns = bytes_at(32, 8),
                                                       .crc = bytes_at(24, 8),
                                                       .record = {.bytes = 36,
                                                                  .accel_ns = bytes_at(0, 8),
                                                                  .gyro_ns = bytes_at(0, 8),
                                                                  .measurement_id = bytes_at(8, 2),
                                                                  .status = bytes_at(10, 2),
                                                                  .accel_at = 12,
                                                                  .gyro_at = 24}};

}  // namespace lxd
