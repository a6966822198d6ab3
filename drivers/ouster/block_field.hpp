// SPDX-License-Identifier: Apache-2.0
// A bit field of blocks that are all of one size: the same value as BitField::get, by one load of four or eight bytes
// that never leaves the block. For loops over the pixels of a column.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "drivers/ouster/bit_field.hpp"

namespace lxd {

class BlockField {
 public:
  // Precondition: the field is present, lies within the block and has at most 32 bits; the block has 4 bytes, or 8 or
  // more.
  constexpr BlockField(const BitField& field, std::size_t block_bytes)
      : narrow_(block_bytes < kWide),
        offset_(std::min<std::size_t>(field.first_bit / 8U, block_bytes - (narrow_ ? kNarrow : kWide))),
        shift_(field.first_bit - 8U * static_cast<unsigned>(offset_)),
        mask_(field.mask()),
        scale_bits_(field.scale_bits) {}

  // Of `count` blocks in a row. Instantiated here, so that the load is one instruction.
  template <typename Value>
  void get(const std::uint8_t* blocks, std::size_t block_bytes, std::size_t count, Value* out) const {
    narrow_ ? get_by<kNarrow>(blocks, block_bytes, count, out) : get_by<kWide>(blocks, block_bytes, count, out);
  }

 private:
  static constexpr std::size_t kNarrow = 4, kWide = 8;

  template <std::size_t kBytes>
  static std::uint64_t load(const std::uint8_t* at) {
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < kBytes; ++i) word |= std::uint64_t{at[i]} << 8U * i;
    return word;
  }
  template <std::size_t kBytes, typename Value>
  void get_by(const std::uint8_t* blocks, std::size_t block_bytes, std::size_t count, Value* out) const {
    const std::uint8_t* at = blocks + offset_;
    for (std::size_t i = 0; i < count; ++i, at += block_bytes) {
      out[i] = static_cast<Value>((load<kBytes>(at) >> shift_ & mask_) << scale_bits_);
    }
  }

  bool narrow_;
  std::size_t offset_;
  unsigned shift_;
  std::uint64_t mask_;
  unsigned scale_bits_;
};

}  // namespace lxd
