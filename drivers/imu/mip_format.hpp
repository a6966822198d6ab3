// SPDX-License-Identifier: Apache-2.0
// MicroStrain's MIP (3DM-GX5, CX5, GQ7, ...): 0x75 0x65, a set, the payload's length, fields, two bytes of Fletcher's
// sum over all before them. A field is its own length with these two bytes, a descriptor and data. Big endian. Sources:
// mip_sdk, mip_packet.c, definitions/data_sensor.h, data_shared.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lxd {

inline constexpr std::array<std::uint8_t, 2> kMipSync{0x75, 0x65};
inline constexpr std::size_t kMipHeaderBytes = 4, kMipChecksumBytes = 2, kMipFieldHeaderBytes = 2;
inline constexpr std::size_t kMipSetAt = 2, kMipLengthAt = 3;
inline constexpr std::size_t kMipMaxPacketBytes = kMipHeaderBytes + 0xFF + kMipChecksumBytes;
inline constexpr std::uint8_t kMipImuSet = 0x80;

struct MipField {
  std::uint8_t descriptor = 0;
  std::uint8_t data_bytes = 0;
};

namespace mip {
inline constexpr MipField kScaledAccel{0x04, 12};    // g
inline constexpr MipField kScaledGyro{0x05, 12};     // rad/s
inline constexpr MipField kGpsTime{0x12, 12};        // f64 time of week in s, u16 week, u16 flags
inline constexpr MipField kSharedGpsTime{0xD3, 12};  // the same with other flags
inline constexpr MipField kReferenceTime{0xD5, 8};   // u64 ns since the device started
inline constexpr std::size_t kWeekAt = 8, kFlagsAt = 10;
inline constexpr unsigned kGpsTimeValid = 0x18, kSharedGpsTimeValid = 0x03;  // time of week and week number both
inline constexpr std::uint64_t kWeek_s = 604'800, kLastWeek = 10'000;        // of 2171: in ns the week fits 63 bits
}  // namespace mip

// Fletcher's sum with 8 bits: first the sum, then the sum of the sums.
constexpr std::array<std::uint8_t, kMipChecksumBytes> mip_checksum(std::span<const std::uint8_t> bytes) {
  unsigned sum = 0, sum_of_sums = 0;
  for (const std::uint8_t byte : bytes) sum_of_sums += sum += byte;
  return {static_cast<std::uint8_t>(sum), static_cast<std::uint8_t>(sum_of_sums)};
}

}  // namespace lxd
