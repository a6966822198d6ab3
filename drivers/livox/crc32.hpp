// SPDX-License-Identifier: Apache-2.0
// CRC-32 of IEEE 802.3, reflected: the check value in the header of Livox packets.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace lxd {

namespace detail {

// Polynomial 0x04C11DB7, bits reversed.
inline constexpr std::uint32_t kCrc32Polynomial = 0xEDB88320U;

constexpr std::array<std::uint32_t, 256> crc32_table() {
  std::array<std::uint32_t, 256> table{};
  for (std::uint32_t byte = 0; byte < table.size(); ++byte) {
    std::uint32_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1U ^ kCrc32Polynomial : crc >> 1U;
    table[byte] = crc;
  }
  return table;
}
inline constexpr std::array<std::uint32_t, 256> kCrc32Table = crc32_table();

}  // namespace detail

// Starts with all ones, ends with the complement.
constexpr std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  std::uint32_t crc = ~0U;
  for (const std::uint8_t byte : bytes) crc = crc >> 8U ^ detail::kCrc32Table[(crc ^ byte) & 0xFFU];
  return ~crc;
}

}  // namespace lxd
