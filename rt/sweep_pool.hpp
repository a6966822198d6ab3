// SPDX-License-Identifier: Apache-2.0
// Sweep buffers of one LiDAR, lent by index out of one arena cut. The driver's thread borrows a sweep, fills it and
// hands its index over through a ring; the estimator's thread reads it in place and gives it back. Points are never
// copied. Drivers that share a thread may share a pool.
#pragma once

#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "rt/arena.hpp"
#include "rt/nonblocking.hpp"
#include "rt/spsc_ring.hpp"
#include "rt/sweep.hpp"

namespace lxd {

using SweepIndex = std::uint16_t;

class SweepPool {
 public:
  // Start-up thread. sweeps buffers of points_per_sweep points each. With an exhausted arena the capacity is 0.
  SweepPool(Arena& arena, std::string_view name, SweepIndex sweeps, std::size_t points_per_sweep);
  SweepPool(const SweepPool&) = delete;
  SweepPool& operator=(const SweepPool&) = delete;

  // Borrower's thread only. An empty sweep (count 0, other fields reset); nothing when all are lent: the caller counts
  // the drop.
  [[nodiscard]] std::optional<SweepIndex> acquire() noexcept LXD_NONBLOCKING;

  // Returner's thread only (may be the borrower's). False, counted and without effect, for an index that is not lent.
  bool release(SweepIndex index) noexcept LXD_NONBLOCKING;

  // The thread that holds the index. Precondition: index < capacity().
  [[nodiscard]] Sweep& operator[](SweepIndex index) noexcept LXD_NONBLOCKING {
    assert(index < capacity());
    return entries_[index].sweep;
  }
  [[nodiscard]] const Sweep& operator[](SweepIndex index) const noexcept LXD_NONBLOCKING {
    assert(index < capacity());
    return entries_[index].sweep;
  }

  // Any thread.
  [[nodiscard]] SweepIndex capacity() const noexcept LXD_NONBLOCKING {
    return static_cast<SweepIndex>(entries_.size());
  }
  // Any thread: sweeps out on loan, a snapshot.
  [[nodiscard]] std::size_t lent() const noexcept LXD_NONBLOCKING { return entries_.size() - free_.size(); }
  // Any thread: the most ever out on loan, as the borrower saw it.
  [[nodiscard]] std::size_t high_water() const noexcept LXD_NONBLOCKING {
    return high_water_.load(std::memory_order_relaxed);
  }
  // Any thread: release() calls with an index that was not lent.
  [[nodiscard]] std::uint64_t misused() const noexcept LXD_NONBLOCKING {
    return misused_.load(std::memory_order_relaxed);
  }

 private:
  struct Entry {
    Sweep sweep;
    std::atomic<bool> lent{false};
  };

  std::span<Entry> entries_;
  SpscRing<SweepIndex> free_;               // from the returner to the borrower
  std::atomic<std::size_t> high_water_{0};  // written by the borrower
  std::atomic<std::uint64_t> misused_{0};   // written by the returner
};

}  // namespace lxd
