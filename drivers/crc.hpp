// SPDX-License-Identifier: Apache-2.0
// The check values of LiDAR packets: reflected CRCs that start with all ones and end with the complement. Eight bytes
// at a time by eight tables ("slicing", Kounavis and Berry, IEEE Trans. Computers 2008): byte by byte it would take
// longer than all else that is done with a packet.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lxd {

namespace detail {

inline constexpr std::size_t kCrcSlices = 8;

// [0]: what a byte leaves behind; [k]: what it leaves with k zeros after it. The polynomial with its bits reversed.
template <typename Word, Word kPolynomial>
constexpr std::array<std::array<Word, 256>, kCrcSlices> reflected_crc_tables() {
  std::array<std::array<Word, 256>, kCrcSlices> tables{};
  for (std::size_t byte = 0; byte < 256; ++byte) {
    auto crc = static_cast<Word>(byte);
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1U ^ kPolynomial : crc >> 1U;
    tables[0][byte] = crc;
  }
  for (std::size_t slice = 1; slice < kCrcSlices; ++slice) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const Word before = tables[slice - 1][byte];
      tables[slice][byte] = before >> 8U ^ tables[0][before & 0xFFU];
    }
  }
  return tables;
}

template <typename Word, Word kPolynomial>
constexpr Word reflected_crc(std::span<const std::uint8_t> bytes) {
  constexpr auto kTables = reflected_crc_tables<Word, kPolynomial>();
  Word crc = static_cast<Word>(~Word{0});
  for (; bytes.size() >= kCrcSlices; bytes = bytes.subspan(kCrcSlices)) {
    std::uint64_t word = crc;
    for (std::size_t i = 0; i < kCrcSlices; ++i) word ^= std::uint64_t{bytes[i]} << 8U * i;
    crc = 0;
    for (std::size_t i = 0; i < kCrcSlices; ++i) crc ^= kTables[kCrcSlices - 1 - i][word >> 8U * i & 0xFFU];
  }
  for (const std::uint8_t byte : bytes) crc = crc >> 8U ^ kTables[0][(crc ^ byte) & 0xFFU];
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
