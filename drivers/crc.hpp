// SPDX-License-Identifier: Apache-2.0
// The check values of LiDAR packets: reflected CRCs that start with all ones and end with the complement.
#pragma once

#include <array>
#include <cstdint>
#include <span>

namespace lxd {

namespace detail {

// The polynomial with its bits reversed.
template <typename Word, Word kPolynomial>
constexpr std::array<Word, 256> reflected_crc_table() {
  std::array<Word, 256> table{};
  for (Word byte = 0; byte < table.size(); ++byte) {
    Word crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1U ^ kPolynomial : crc >> 1U;
    table[byte] = crc;
  }
  return table;
}

template <typename Word, Word kPolynomial>
constexpr Word reflected_crc(std::span<const std::uint8_t> bytes) {
  constexpr std::array<Word, 256> kTable = reflected_crc_table<Word, kPolynomial>();
  Word crc = static_cast<Word>(~Word{0});
  for (const std::uint8_t byte : bytes) crc = crc >> 8U ^ kTable[(crc ^ byte) & 0xFFU];
  return static_cast<Word>(~crc);
}

}  // namespace detail

// CRC-32 of IEEE 802.3, 0x04C11DB7: Livox packets.
constexpr std::uint32_t crc32(std::span<const std::uint8_t> bytes) {
  return detail::reflected_crc<std::uint32_t, 0xEDB88320U>(bytes);
}

// CRC-64/ECMA-182 reflected (CRC-64/XZ), 0x42F0E1EBA9EA3693: Ouster packets.
constexpr std::uint64_t crc64(std::span<const std::uint8_t> bytes) {
  return detail::reflected_crc<std::uint64_t, 0xC96C5795D7870F42ULL>(bytes);
}

}  // namespace lxd
