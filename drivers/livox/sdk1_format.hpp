// SPDX-License-Identifier: Apache-2.0
// The shape of a Livox SDK1 datagram (Mid-40, Mid-70, Horizon, Avia, Tele-15): a header of 18 bytes, then records as
// many as fit. It has neither length nor check value. Source: Livox-SDK 9306596, sdk_core/include/livox_def.h; Livox
// SDK communication protocol 1.3.0.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "drivers/livox/packet_format.hpp"

namespace lxd {

struct LivoxSdk1HeaderFields {
  BitField version = bytes_at(0, 1);
  BitField error_code = bytes_at(4, 4);
  BitField time_type = bytes_at(8, 1);
  BitField data_type = bytes_at(9, 1);
};
inline constexpr LivoxSdk1HeaderFields kLivoxSdk1Header{};
inline constexpr std::size_t kLivoxSdk1HeaderBytes = 18;
inline constexpr std::size_t kLivoxSdk1TimeAt = 10;     // eight bytes, of the first shot
inline constexpr std::size_t kLivoxSdk1ShotsMax = 120;  // the maker's software reserves no more; sensors send about 100

// What the time stamp is of.
inline constexpr std::uint64_t kLivoxSdk1Uptime = 0, kLivoxSdk1Ptp = 1, kLivoxSdk1Gps = 3, kLivoxSdk1Pps = 4;
// With GPS: UTC in parts. Microseconds count from the full hour.
struct LivoxSdk1UtcFields {
  BitField year = bytes_at(0, 1), month = bytes_at(1, 1), day = bytes_at(2, 1), hour = bytes_at(3, 1);
  BitField microseconds = bytes_at(4, 4);
};
inline constexpr LivoxSdk1UtcFields kLivoxSdk1Utc{};
inline constexpr int kLivoxSdk1FirstYear = 2000;

namespace detail {

constexpr LivoxRecord cartesian_record(std::uint8_t type, std::size_t bytes, std::uint32_t echoes, bool tag) {
  return {.data_type = type,
          .bytes = bytes,
          .echoes = echoes,
          .echo_bytes = bytes / echoes,
          .unit_m = 1e-3,
          .x = bytes_at(0, 4),
          .y = bytes_at(4, 4),
          .z = bytes_at(8, 4),
          .reflectivity = bytes_at(12, 1),
          .tag = tag ? bytes_at(13, 1) : BitField{},
          .tags = LivoxTags::kSdk1};
}

// One echo: depth before the angles.
constexpr LivoxRecord spherical_record(std::uint8_t type, std::size_t bytes, bool tag) {
  return {.data_type = type,
          .bytes = bytes,
          .unit_m = 1e-3,
          .depth = bytes_at(0, 4),
          .zenith = bytes_at(4, 2),
          .azimuth = bytes_at(6, 2),
          .reflectivity = bytes_at(8, 1),
          .tag = tag ? bytes_at(9, 1) : BitField{},
          .tags = LivoxTags::kSdk1};
}

// Several echoes: the angles they share come first.
constexpr LivoxRecord spherical_echoes(std::uint8_t type, std::size_t bytes, std::uint32_t echoes) {
  return {.data_type = type,
          .bytes = bytes,
          .echoes = echoes,
          .echo_bytes = 6,
          .unit_m = 1e-3,
          .depth = bytes_at(4, 4),
          .zenith = bytes_at(0, 2),
          .azimuth = bytes_at(2, 2),
          .reflectivity = bytes_at(8, 1),
          .tag = bytes_at(9, 1),
          .tags = LivoxTags::kSdk1};
}

}  // namespace detail

inline constexpr std::array kLivoxSdk1Records{
    detail::cartesian_record(0, 13, 1, false), detail::spherical_record(1, 9, false),
    detail::cartesian_record(2, 14, 1, true),  detail::spherical_record(3, 10, true),
    detail::cartesian_record(4, 28, 2, true),  detail::spherical_echoes(5, 16, 2),
    detail::cartesian_record(7, 42, 3, true),  detail::spherical_echoes(8, 22, 3),
};
inline constexpr std::uint64_t kLivoxSdk1ImuType = 6;  // its record is that of SDK2

constexpr const LivoxRecord* find_livox_sdk1_record(std::uint64_t data_type) {
  for (const LivoxRecord& record : kLivoxSdk1Records) {
    if (record.data_type == data_type) return &record;
  }
  return nullptr;
}

// From one shot to the next, which no packet says.
inline constexpr std::uint32_t kLivoxMidShot_ns = 10'000;     // Mid-40, Mid-70: 100,000 a second
inline constexpr std::uint32_t kLivoxHorizonShot_ns = 4'167;  // Horizon, Avia, Tele-15: 240,000 a second

}  // namespace lxd
