// SPDX-License-Identifier: Apache-2.0
// CRC-64/ECMA-182, reflected (known as CRC-64/XZ): the check value in the footer of Ouster packets.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace lxd {

namespace detail {

// Polynomial 0x42F0E1EBA9EA3693, bits reversed.
inline constexpr std::uint64_t kCrc64Polynomial = 0xC96C5795D7870F42ULL;

constexpr std::array<std::uint64_t, 256> crc64_table() {
  std::array<std::uint64_t, 256> table{};
  for (std::uint64_t byte = 0; byte < table.size(); ++byte) {
    std::uint64_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1U ^ kCrc64Polynomial : crc >> 1U;
    table[byte] = crc;
  }
  return table;
}
inline constexpr std::array<std::uint64_t, 256> kCrc64Table = crc64_table();

}  // namespace detail

// Starts with all ones, ends with the complement.
constexpr std::uint64_t crc64(std::span<const std::uint8_t> bytes) {
  std::uint64_t crc = ~0ULL;
  for (const std::uint8_t byte : bytes) crc = crc >> 8U ^ detail::kCrc64Table[(crc ^ byte) & 0xFFU];
  return ~crc;
}

}  // namespace lxd
