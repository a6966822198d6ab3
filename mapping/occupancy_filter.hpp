// SPDX-License-Identifier: Apache-2.0
// Where a sub-mesh may have surfaces, so that a ray passes empty space in steps of many cells: one bit for each of a
// number of hashed blocks of cells. A block that holds a surface always says so; a block without one rarely does (a
// Bloom filter of one hash: Bloom 1970). 16 KiB, which stay in the cache, and are cleared in a microsecond.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include "mapping/lattice.hpp"

namespace lxd {

class OccupancyFilter {
 public:
  static constexpr int kBlockShift = 2;
  static constexpr int kBlockEdge = 1 << kBlockShift;  // cells

  static constexpr int kWordShift = 6;  // bits of a word, as a power of two
  static constexpr std::size_t kBits = std::size_t{1} << 17;
  static constexpr std::size_t kWords = kBits >> kWordShift;

  // words.size(): kWords, zeroed.
  explicit OccupancyFilter(std::span<std::uint64_t> words) : words_(words) {}

  static CellIndex block_of(const CellIndex& cell) {
    return {cell.x() >> kBlockShift, cell.y() >> kBlockShift, cell.z() >> kBlockShift};
  }

  void clear() { std::fill(words_.begin(), words_.end(), 0); }
  void insert(const CellIndex& cell) {
    const std::size_t bit = bit_of(block_of(cell));
    words_[bit >> kWordShift] |= std::uint64_t{1} << (bit & kWordMask);
  }
  [[nodiscard]] bool may_hold(const CellIndex& block) const {
    const std::size_t bit = bit_of(block);
    return (words_[bit >> kWordShift] >> (bit & kWordMask) & 1u) != 0;
  }

 private:
  static constexpr std::size_t kWordMask = (1u << kWordShift) - 1;

  static std::size_t bit_of(const CellIndex& block) {
    return static_cast<std::size_t>(scatter(pack(block))) & (kBits - 1);
  }

  std::span<std::uint64_t> words_;
};

}  // namespace lxd
