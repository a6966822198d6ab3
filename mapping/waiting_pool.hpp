// SPDX-License-Identifier: Apache-2.0
// The waiting blocks of a sub-mesh, lent to its cells. When all are lent, one goes from a cell that the LiDAR no longer
// sees to one that it sees now. Real-time thread only.
#pragma once

#include <cstdint>
#include <span>

#include "mapping/lattice.hpp"
#include "mapping/waiting_points.hpp"
#include "rt/arena.hpp"

namespace lxd {

class WaitingPool {
 public:
  static constexpr std::uint32_t kStaleSweeps = 5;  // without a point: the cell has left the view, or is hardly in it
  static constexpr int kTriesMax = 16;              // blocks looked at for a stale one

  WaitingPool(std::uint32_t blocks, Arena& arena);

  void clear();  // constant time

  struct Loan {
    std::uint32_t block = kNone;   // kNone: all are lent, and none of those looked at is stale
    std::uint32_t robbed = kNone;  // the cell that loses this block and the points in it
  };
  // An empty block for `cell`, which must keep touch()ing it.
  [[nodiscard]] Loan lend(std::uint32_t cell, std::uint32_t sweep);
  void give_back(std::uint32_t block);

  [[nodiscard]] WaitingBlock& operator[](std::uint32_t block) { return blocks_[block]; }

 private:
  [[nodiscard]] Loan find_block(std::uint32_t sweep);

  std::span<WaitingBlock> blocks_;
  std::span<std::uint32_t> free_;  // stack
  std::uint32_t used_ = 0, free_count_ = 0;
  std::uint32_t hand_ = 0;  // where the search for a stale one goes on, round and round
};

}  // namespace lxd
