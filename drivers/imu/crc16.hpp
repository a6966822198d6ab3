// SPDX-License-Identifier: Apache-2.0
// CRC-16 of polynomial 0x1021 without reflection: CRC-16/XMODEM begins with 0, CRC-16/CCITT-FALSE with all ones. Over a
// message followed by its own CRC, high byte first, it is 0.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace lxd {

constexpr std::array<std::uint16_t, 256> make_crc16_table() {
  constexpr unsigned kPolynomial = 0x1021, kHighBit = 0x8000;
  std::array<std::uint16_t, 256> table{};
  for (unsigned byte = 0; byte < table.size(); ++byte) {
    unsigned crc = byte << 8U;
    for (int bit = 0; bit < 8; ++bit) crc = crc << 1U ^ ((crc & kHighBit) != 0 ? kPolynomial : 0U);
    table[byte] = static_cast<std::uint16_t>(crc);
  }
  return table;
}

inline constexpr std::array<std::uint16_t, 256> kCrc16Table = make_crc16_table();

constexpr std::uint16_t crc16(std::span<const std::uint8_t> bytes, unsigned initial = 0) {
  unsigned crc = initial;
  for (const std::uint8_t byte : bytes) crc = (crc << 8U ^ kCrc16Table[(crc >> 8U ^ byte) & 0xFFU]) & 0xFFFFU;
  return static_cast<std::uint16_t>(crc);
}

}  // namespace lxd
