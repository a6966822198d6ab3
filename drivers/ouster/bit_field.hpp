// SPDX-License-Identifier: Apache-2.0
// A field of a little-endian block, by its bits. Bytes are loaded one by one: neither alignment nor bytes beyond the
// field are needed. The same table entry reads packets (parser) and writes them (simulator, tests).
#pragma once

#include <cstdint>

namespace lxd {

struct BitField {
  std::uint16_t first_bit = 0;  // counted from the least significant bit of the block
  std::uint8_t bits = 0;        // 1..64 (at most 8 bytes touched); 0: there is no such field
  std::uint8_t scale_bits = 0;  // value = raw << scale_bits (the low-bandwidth profiles send coarse units)

  [[nodiscard]] constexpr bool present() const { return bits != 0; }
  [[nodiscard]] constexpr std::uint64_t mask() const { return bits == 64 ? ~0ULL : (1ULL << bits) - 1; }

  // Precondition of get and set: the block reaches to the field's last byte.
  [[nodiscard]] constexpr std::uint64_t get(const std::uint8_t* block) const {
    if (!present()) return 0;
    std::uint64_t raw = 0;
    for (int byte = last_byte(); byte >= first_byte(); --byte) raw = raw << 8U | block[byte];
    return (raw >> (first_bit % 8U) & mask()) << scale_bits;
  }
  constexpr void set(std::uint8_t* block, std::uint64_t value) const {
    if (!present()) return;
    const std::uint64_t kept = mask() << (first_bit % 8U);
    const std::uint64_t raw = (value >> scale_bits & mask()) << (first_bit % 8U);
    for (int byte = first_byte(); byte <= last_byte(); ++byte) {
      const auto shift = static_cast<unsigned>(8 * (byte - first_byte()));
      block[byte] = static_cast<std::uint8_t>((block[byte] & ~(kept >> shift)) | (raw >> shift & 0xFFU));
    }
  }

 private:
  [[nodiscard]] constexpr int first_byte() const { return first_bit / 8; }
  [[nodiscard]] constexpr int last_byte() const { return (first_bit + bits - 1) / 8; }
};

// A field of whole bytes.
constexpr BitField bytes_at(int offset, int count) {
  return {static_cast<std::uint16_t>(8 * offset), static_cast<std::uint8_t>(8 * count), 0};
}

}  // namespace lxd
