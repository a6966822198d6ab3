// SPDX-License-Identifier: Apache-2.0
// A fixed number of elements over arena storage, lent by index in constant time. Belongs to one thread at a time
// (rt/sweep_pool.hpp is the pool between two). An empty pool refuses; it never grows and never blocks.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "rt/arena.hpp"
#include "rt/nonblocking.hpp"

namespace lxd {

template <typename T>
class FixedPool {
 public:
  using Index = std::uint32_t;

  // Start-up thread. With an exhausted arena the pool has capacity 0 and refuses everything.
  FixedPool(Arena& arena, std::string_view name, Index count)
      : elements_(arena.take<T>(name, count)), next_(arena.take<Index>(std::string(name) + " free list", count)) {
    if (elements_.empty() || next_.empty()) elements_ = {}, next_ = {};
    for (Index i = 0; i < capacity(); ++i) next_[i] = i + 1 < capacity() ? i + 1 : kEnd;
    free_ = next_.empty() ? kEnd : 0;
  }
  FixedPool(const FixedPool&) = delete;
  FixedPool& operator=(const FixedPool&) = delete;

  // Nothing when all are lent. The element is as its last user left it (value-initialised at first).
  [[nodiscard]] std::optional<Index> acquire() noexcept LXD_NONBLOCKING {
    if (free_ == kEnd) {
      ++refused_;
      return std::nullopt;
    }
    const Index index = free_;
    free_ = next_[index];
    next_[index] = kLent;
    high_water_ = std::max(high_water_, ++lent_);
    return index;
  }

  // False, counted and without effect, for an index that is not lent; in a debug build such a caller also trips an
  // assertion.
  bool release(Index index) noexcept LXD_NONBLOCKING {
    if (!is_lent(index)) {
      ++misused_;
      assert(false && "release of an element that is not lent");
      return false;
    }
    next_[index] = free_;
    free_ = index;
    --lent_;
    return true;
  }

  // Precondition: index < capacity().
  [[nodiscard]] T& operator[](Index index) noexcept LXD_NONBLOCKING {
    assert(index < capacity());
    return elements_[index];
  }
  [[nodiscard]] const T& operator[](Index index) const noexcept LXD_NONBLOCKING {
    assert(index < capacity());
    return elements_[index];
  }

  [[nodiscard]] bool is_lent(Index index) const noexcept LXD_NONBLOCKING {
    return index < capacity() && next_[index] == kLent;
  }
  [[nodiscard]] Index capacity() const noexcept LXD_NONBLOCKING { return static_cast<Index>(next_.size()); }
  [[nodiscard]] Index lent() const noexcept LXD_NONBLOCKING { return lent_; }
  [[nodiscard]] Index high_water() const noexcept LXD_NONBLOCKING { return high_water_; }
  // acquire() calls that found the pool empty.
  [[nodiscard]] std::uint64_t refused() const noexcept LXD_NONBLOCKING { return refused_; }
  // release() calls with an index that was not lent.
  [[nodiscard]] std::uint64_t misused() const noexcept LXD_NONBLOCKING { return misused_; }

 private:
  static constexpr Index kEnd = std::numeric_limits<Index>::max();
  static constexpr Index kLent = kEnd - 1;

  std::span<T> elements_;
  std::span<Index> next_;  // of a free element: the next free one; of a lent element: kLent
  Index free_ = kEnd;      // first free element
  Index lent_ = 0;
  Index high_water_ = 0;
  std::uint64_t refused_ = 0;
  std::uint64_t misused_ = 0;
};

}  // namespace lxd
