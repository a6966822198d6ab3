// SPDX-License-Identifier: Apache-2.0
// Wait-free queue from one producer thread to one consumer thread over storage that the arena lends. It refuses when it
// is full; rt/spsc_drop_oldest_ring.hpp is the one that drops. Made at start-up, before the two threads run.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <type_traits>

#include "rt/cache_line.hpp"
#include "rt/nonblocking.hpp"

namespace lxd {

template <typename T>
class SpscRing {
  static_assert(std::is_trivially_destructible_v<T>, "popped elements are left in their slot");

 public:
  // Uses the largest power of two of slots that storage has; an empty storage makes a ring that refuses everything.
  explicit SpscRing(std::span<T> storage) noexcept : slots_(storage.first(std::bit_floor(storage.size()))) {}
  SpscRing(const SpscRing&) = delete;
  SpscRing& operator=(const SpscRing&) = delete;

  // Producer thread only. False when full: the element is not taken and the caller counts the drop.
  [[nodiscard]] bool push(const T& element) noexcept LXD_NONBLOCKING {
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
    const std::uint64_t used = tail - head_.load(std::memory_order_acquire);
    if (used == slots_.size()) return false;
    slots_[slot(tail)] = element;
    tail_.store(tail + 1, std::memory_order_release);
    if (used + 1 > high_water_.load(std::memory_order_relaxed)) high_water_.store(used + 1, std::memory_order_relaxed);
    return true;
  }

  // Consumer thread only. The oldest element, or nullptr when empty; it stays valid until the next pop() or
  // drop_front().
  [[nodiscard]] const T* front() const noexcept LXD_NONBLOCKING {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    return head == tail_.load(std::memory_order_acquire) ? nullptr : &slots_[slot(head)];
  }

  // Consumer thread only. For elements that are worth reading in place. Does nothing when empty.
  void drop_front() noexcept LXD_NONBLOCKING {
    if (front() != nullptr) head_.store(head_.load(std::memory_order_relaxed) + 1, std::memory_order_release);
  }

  // Consumer thread only.
  std::optional<T> pop() noexcept LXD_NONBLOCKING {
    const T* const oldest = front();
    if (oldest == nullptr) return std::nullopt;
    std::optional<T> element(*oldest);
    drop_front();
    return element;
  }

  // Any thread. Exact while the other side rests; from the producer's thread never too small, from the consumer's never
  // too large; from a third thread a snapshot within [0, capacity()].
  [[nodiscard]] std::size_t size() const noexcept LXD_NONBLOCKING {
    const std::uint64_t head = head_.load(std::memory_order_acquire);  // first: head never passes a later tail
    const std::uint64_t tail = tail_.load(std::memory_order_acquire);
    return static_cast<std::size_t>(std::min<std::uint64_t>(tail - head, slots_.size()));
  }
  [[nodiscard]] bool empty() const noexcept LXD_NONBLOCKING { return size() == 0; }

  // Any thread. The most elements that ever waited, as the producer saw it.
  [[nodiscard]] std::size_t high_water() const noexcept LXD_NONBLOCKING {
    return static_cast<std::size_t>(high_water_.load(std::memory_order_relaxed));
  }
  // Any thread.
  [[nodiscard]] std::size_t capacity() const noexcept LXD_NONBLOCKING { return slots_.size(); }

 private:
  [[nodiscard]] std::size_t slot(std::uint64_t count) const noexcept LXD_NONBLOCKING {
    return static_cast<std::size_t>(count & (slots_.size() - 1));
  }

  std::span<T> slots_;
  // Elements ever pushed and popped: 64 bits do not wrap in the life of a rig.
  alignas(kCacheLine_bytes) std::atomic<std::uint64_t> tail_{0};  // written by the producer
  std::atomic<std::uint64_t> high_water_{0};                      // written by the producer
  alignas(kCacheLine_bytes) std::atomic<std::uint64_t> head_{0};  // written by the consumer
};

}  // namespace lxd
