// SPDX-License-Identifier: Apache-2.0
#include "mapping/waiting_pool.hpp"

namespace lxd {

WaitingPool::WaitingPool(std::uint32_t blocks, Arena& arena)
    : blocks_(arena.take<WaitingBlock>("map waiting points", blocks)),
      free_(arena.take<std::uint32_t>("map waiting free list", blocks)) {}

void WaitingPool::clear() { used_ = free_count_ = hand_ = 0; }

WaitingPool::Loan WaitingPool::lend(std::uint32_t cell, std::uint32_t sweep) {
  const Loan loan = find_block(sweep);
  if (loan.block == kNone) return loan;
  WaitingBlock& block = blocks_[loan.block];
  block.cell = cell;
  block.last_sweep = sweep;
  block.count = 0;
  block.offered = 0;
  return loan;
}

WaitingPool::Loan WaitingPool::find_block(std::uint32_t sweep) {
  if (free_count_ > 0) return {free_[--free_count_], kNone};
  if (used_ < blocks_.size()) return {used_++, kNone};
  for (int i = 0; i < kTriesMax && !blocks_.empty(); ++i) {
    const std::uint32_t candidate = hand_;
    hand_ = hand_ + 1 < blocks_.size() ? hand_ + 1 : 0;
    if (sweep - blocks_[candidate].last_sweep > kStaleSweeps) return {candidate, blocks_[candidate].cell};
  }
  return {};
}

void WaitingPool::give_back(std::uint32_t block) { free_[free_count_++] = block; }

}  // namespace lxd
