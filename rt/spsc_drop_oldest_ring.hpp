// SPDX-License-Identifier: Apache-2.0
// Queue from one producer thread to one consumer thread in which the newest data wins: a full ring overwrites its
// oldest element, and what the consumer lost that way is counted. push() is wait-free and never waits for the consumer;
// pop() is bounded. Made at start-up, before the two threads run. rt/README.md argues the protocol.
#pragma once

#include <algorithm>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "rt/atomic_record.hpp"
#include "rt/cache_line.hpp"
#include "rt/nonblocking.hpp"

namespace lxd {

template <typename T>
class SpscDropOldestRing {
 public:
  using Slot = AtomicRecord<T>;

  // Uses the largest power of two of slots that storage has; an empty storage makes a ring that drops everything.
  explicit SpscDropOldestRing(std::span<Slot> storage) noexcept
      : slots_(storage.first(std::bit_floor(storage.size()))) {}
  SpscDropOldestRing(const SpscDropOldestRing&) = delete;
  SpscDropOldestRing& operator=(const SpscDropOldestRing&) = delete;

  // Producer thread only.
  void push(const T& element) noexcept LXD_NONBLOCKING {
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
    if (!slots_.empty()) slots_[slot(tail)].store(tail, element);
    tail_.store(tail + 1, std::memory_order_release);
    note_fill(tail + 1);
  }

  // Consumer thread only. Nothing when the ring is empty, and also when the producer overtook kAttempts copies in a
  // row, each farther from the end that is overwritten; the next pop() then goes on with what is there.
  std::optional<T> pop() noexcept LXD_NONBLOCKING {
    T element;
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const std::uint64_t tail = tail_.load(std::memory_order_acquire);
      skip_to_newest(tail, slots_.size() - margin(attempt));
      const std::uint64_t head = head_.load(std::memory_order_relaxed);
      if (head == tail) return std::nullopt;
      if (!slots_[slot(head)].load(head, element)) continue;
      head_.store(head + 1, std::memory_order_release);
      return element;
    }
    return std::nullopt;
  }

  // Any thread. Elements overwritten before the consumer had them; a pop() under way is counted when it ends. After
  // both threads rest: pushed = popped + dropped() + size().
  [[nodiscard]] std::uint64_t dropped() const noexcept LXD_NONBLOCKING {
    const std::uint64_t passed = dropped_.load(std::memory_order_acquire);
    const std::uint64_t waiting = unread();
    return passed + (waiting > slots_.size() ? waiting - slots_.size() : 0);
  }

  // Any thread; a snapshot within [0, capacity()].
  [[nodiscard]] std::size_t size() const noexcept LXD_NONBLOCKING {
    return std::min<std::uint64_t>(unread(), slots_.size());
  }
  [[nodiscard]] bool empty() const noexcept LXD_NONBLOCKING { return size() == 0; }

  // Any thread. The most elements that ever waited, as the producer saw it.
  [[nodiscard]] std::size_t high_water() const noexcept LXD_NONBLOCKING {
    return static_cast<std::size_t>(high_water_.load(std::memory_order_relaxed));
  }
  // Any thread.
  [[nodiscard]] std::size_t capacity() const noexcept LXD_NONBLOCKING { return slots_.size(); }

 private:
  static constexpr int kAttempts = 4;

  [[nodiscard]] std::size_t slot(std::uint64_t count) const noexcept LXD_NONBLOCKING {
    return static_cast<std::size_t>(count) & (slots_.size() - 1);
  }

  [[nodiscard]] std::uint64_t unread() const noexcept LXD_NONBLOCKING {
    const std::uint64_t head = head_.load(std::memory_order_acquire);  // first: head never passes a later tail
    return tail_.load(std::memory_order_acquire) - head;
  }

  // Oldest elements given up before an attempt: none; the one whose slot the producer is just writing; then a quarter
  // and a half of the ring, for a producer that laps this consumer while it copies.
  [[nodiscard]] std::size_t margin(int attempt) const noexcept LXD_NONBLOCKING {
    return attempt < 2 ? std::min<std::size_t>(attempt, slots_.size()) : slots_.size() >> (kAttempts - attempt);
  }

  // Producer: how full the ring is after a push.
  void note_fill(std::uint64_t tail) noexcept LXD_NONBLOCKING {
    const std::uint64_t waiting = tail - head_.load(std::memory_order_relaxed);
    const std::uint64_t fill = std::min<std::uint64_t>(waiting, slots_.size());
    if (fill > high_water_.load(std::memory_order_relaxed)) high_water_.store(fill, std::memory_order_relaxed);
  }

  // Consumer: lets go of everything older than the newest `keep` elements (at least one).
  void skip_to_newest(std::uint64_t tail, std::uint64_t keep) noexcept LXD_NONBLOCKING {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    const std::uint64_t wanted = slots_.empty() ? 0 : std::max<std::uint64_t>(keep, 1);
    if (tail - head <= wanted) return;
    head_.store(tail - wanted, std::memory_order_release);  // first: dropped() may lag, but never counts one twice
    dropped_.store(dropped_.load(std::memory_order_relaxed) + (tail - wanted - head), std::memory_order_release);
  }

  std::span<Slot> slots_;
  // Elements ever pushed, and ever popped or dropped: 64 bits do not wrap in the life of a rig.
  alignas(kCacheLine_bytes) std::atomic<std::uint64_t> tail_{0};  // written by the producer
  std::atomic<std::uint64_t> high_water_{0};                      // written by the producer
  alignas(kCacheLine_bytes) std::atomic<std::uint64_t> head_{0};  // written by the consumer
  std::atomic<std::uint64_t> dropped_{0};                         // written by the consumer
};

}  // namespace lxd
