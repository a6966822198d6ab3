// SPDX-License-Identifier: Apache-2.0
// Which cells may hold what a ray asks for: 64 bits for each block of 4 x 4 x 4 at a hashed place, so that a ray
// looks once a block into memory that stays in the cache. A cell that was inserted always says so; blocks that share a
// place say it for each other (a Bloom filter of one hash: Bloom 1970).
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>

#include "mapping/occupancy_filter.hpp"

namespace lxd {

class CellFilter {
 public:
  static constexpr int kBlockEdge = OccupancyFilter::kBlockEdge;  // cells
  static constexpr std::size_t kWordsMax = std::size_t{1} << 17;  // 512 KiB: more would not stay in the cache

  // words.size(): at least 2; the largest power of two of them is used.
  explicit CellFilter(std::span<std::uint32_t> words)
      : words_(words.first(std::bit_floor(std::min(words.size(), kWordsMax)))) {
    std::ranges::fill(words_, 0);
  }

  void insert(const CellIndex& cell) {
    const std::uint64_t bit = bit_of(cell);
    const std::size_t at = place_of(block_of(cell));
    words_[at] |= static_cast<std::uint32_t>(bit);
    words_[at + 1] |= static_cast<std::uint32_t>(bit >> 32);
  }

  static CellIndex block_of(const CellIndex& cell) { return OccupancyFilter::block_of(cell); }

  // One bit a cell of the block.
  [[nodiscard]] std::uint64_t cells_of(const CellIndex& block) const {
    const std::size_t at = place_of(block);
    return words_[at] | std::uint64_t{words_[at + 1]} << 32;
  }
  static std::uint64_t bit_of(const CellIndex& cell) {
    constexpr int kWithin = kBlockEdge - 1, kShift = OccupancyFilter::kBlockShift;
    return std::uint64_t{1} << ((cell.x() & kWithin) << 2 * kShift | (cell.y() & kWithin) << kShift |
                                (cell.z() & kWithin));
  }

 private:
  [[nodiscard]] std::size_t place_of(const CellIndex& block) const {
    return static_cast<std::size_t>(scatter(pack(block))) & (words_.size() - 2);
  }

  std::span<std::uint32_t> words_;
};

}  // namespace lxd
