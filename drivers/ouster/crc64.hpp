// SPDX-License-Identifier: Apache-2.0
// CRC-64/ECMA-182, reflected (known as CRC-64/XZ): the check value in the footer of Ouster packets. Eight bytes at a
// time by eight tables ("slicing", Kounavis and Berry, IEEE Trans. Computers 2008): byte by byte it would take longer
// than all else that is done with a packet.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lxd {

namespace detail {

// Polynomial 0x42F0E1EBA9EA3693, bits reversed.
inline constexpr std::uint64_t kCrc64Polynomial = 0xC96C5795D7870F42ULL;
inline constexpr std::size_t kCrc64Slices = 8;
using Crc64Tables = std::array<std::array<std::uint64_t, 256>, kCrc64Slices>;

// [0]: what a byte leaves behind; [k]: what it leaves with k zeros after it.
constexpr Crc64Tables make_crc64_tables() {
  Crc64Tables tables{};
  for (std::uint64_t byte = 0; byte < 256; ++byte) {
    std::uint64_t crc = byte;
    for (int bit = 0; bit < 8; ++bit) crc = (crc & 1U) != 0 ? crc >> 1U ^ kCrc64Polynomial : crc >> 1U;
    tables[0][byte] = crc;
  }
  for (std::size_t slice = 1; slice < kCrc64Slices; ++slice) {
    for (std::size_t byte = 0; byte < 256; ++byte) {
      const std::uint64_t before = tables[slice - 1][byte];
      tables[slice][byte] = before >> 8U ^ tables[0][before & 0xFFU];
    }
  }
  return tables;
}
inline constexpr Crc64Tables kCrc64Tables = make_crc64_tables();

}  // namespace detail

// Starts with all ones, ends with the complement.
constexpr std::uint64_t crc64(std::span<const std::uint8_t> bytes) {
  using detail::kCrc64Slices, detail::kCrc64Tables;
  std::uint64_t crc = ~0ULL;
  for (; bytes.size() >= kCrc64Slices; bytes = bytes.subspan(kCrc64Slices)) {
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < kCrc64Slices; ++i) word |= std::uint64_t{bytes[i]} << 8U * i;
    word ^= crc;
    crc = 0;
    for (std::size_t i = 0; i < kCrc64Slices; ++i) crc ^= kCrc64Tables[kCrc64Slices - 1 - i][word >> 8U * i & 0xFFU];
  }
  for (const std::uint8_t byte : bytes) crc = crc >> 8U ^ kCrc64Tables[0][(crc ^ byte) & 0xFFU];
  return ~crc;
}

}  // namespace lxd
