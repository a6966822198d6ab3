// SPDX-License-Identifier: Apache-2.0
// Sweep buffers lent by index (see the header).
#include "rt/sweep_pool.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <string>

namespace lxd {

SweepPool::SweepPool(Arena& arena, std::string_view name, SweepIndex sweeps, std::size_t points_per_sweep)
    : entries_(arena.take<Entry>(std::string(name) + " headers", sweeps)),
      free_(arena.take<SweepIndex>(std::string(name) + " free list", std::bit_ceil(std::size_t{sweeps}))) {
  const std::span<LidarPoint> points = arena.take<LidarPoint>(name, sweeps * points_per_sweep);
  if (arena.exhausted()) entries_ = {};
  for (SweepIndex i = 0; i < capacity(); ++i) {
    entries_[i].sweep.storage = points.subspan(i * points_per_sweep, points_per_sweep);
    (void)free_.push(i);  // has room for all of them
  }
}

std::optional<SweepIndex> SweepPool::acquire() noexcept LXD_NONBLOCKING {
  const std::optional<SweepIndex> index = free_.pop();
  if (!index) return std::nullopt;
  Entry& entry = entries_[*index];
  entry.lent.store(true, std::memory_order_relaxed);  // published by the ring that hands the index over
  const std::span<LidarPoint> storage = entry.sweep.storage;
  entry.sweep = Sweep{};
  entry.sweep.storage = storage;
  high_water_.store(std::max(high_water(), lent()), std::memory_order_relaxed);
  return index;
}

bool SweepPool::release(SweepIndex index) noexcept LXD_NONBLOCKING {
  if (index >= capacity() || !entries_[index].lent.exchange(false, std::memory_order_relaxed)) {
    misused_.fetch_add(1, std::memory_order_relaxed);
    assert(false && "release of a sweep that is not lent");
    return false;
  }
  return free_.push(index);
}

}  // namespace lxd
