// SPDX-License-Identifier: Apache-2.0
// Wait-free queue of records of one byte or more, from one producer thread to one consumer thread, over storage that is
// lent once. It refuses when it is full. Made at start-up, before the two threads run.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cstdint>
#include <cstring>
#include <span>

#include "rt/cache_line.hpp"
#include "rt/nonblocking.hpp"

namespace lxd {

class ByteRing {
 public:
  using Bytes = std::span<const std::uint8_t>;

  // Uses the largest power of two of bytes that storage has; an empty storage makes a ring that refuses everything.
  explicit ByteRing(std::span<std::uint8_t> storage) noexcept
      : storage_(storage.first(std::bit_floor(storage.size()))) {}
  ByteRing(const ByteRing&) = delete;
  ByteRing& operator=(const ByteRing&) = delete;

  // Producer thread only. A record of two parts, which pop() gives as one. False when there is no room for it: it is
  // not taken, and the caller counts the drop.
  [[nodiscard]] bool push(Bytes head, Bytes body) noexcept LXD_NONBLOCKING {
    const std::uint64_t tail = tail_.load(std::memory_order_relaxed);
    const std::uint64_t used = tail - head_.load(std::memory_order_acquire);
    const auto bytes = static_cast<std::uint32_t>(head.size() + body.size());
    const std::uint64_t wanted = kLengthBytes + std::uint64_t{bytes};
    if (wanted > storage_.size() - used) return false;
    std::array<std::uint8_t, kLengthBytes> length{};
    std::memcpy(length.data(), &bytes, kLengthBytes);
    put(tail, length);
    put(tail + kLengthBytes, head);
    put(tail + kLengthBytes + head.size(), body);
    tail_.store(tail + wanted, std::memory_order_release);
    if (used + wanted > high_water_.load(std::memory_order_relaxed))
      high_water_.store(used + wanted, std::memory_order_relaxed);
    return true;
  }

  // Consumer thread only. Copies the oldest record and gives its bytes; none: the ring is empty. A record longer than
  // `out` is cut.
  [[nodiscard]] std::span<std::uint8_t> pop(std::span<std::uint8_t> out) noexcept LXD_NONBLOCKING {
    const std::uint64_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_.load(std::memory_order_acquire)) return {};
    std::array<std::uint8_t, kLengthBytes> length{};
    get(head, length);
    std::uint32_t bytes = 0;
    std::memcpy(&bytes, length.data(), kLengthBytes);
    const auto taken = out.first(std::min<std::size_t>(out.size(), bytes));
    get(head + kLengthBytes, taken);
    head_.store(head + kLengthBytes + bytes, std::memory_order_release);
    return taken;
  }

  // Any thread; a snapshot. Bytes that wait, with those that the ring itself needs.
  [[nodiscard]] std::size_t size() const noexcept LXD_NONBLOCKING {
    const std::uint64_t head = head_.load(std::memory_order_acquire);
    const std::uint64_t waiting = tail_.load(std::memory_order_acquire) - head;
    return static_cast<std::size_t>(std::min<std::uint64_t>(waiting, storage_.size()));
  }
  [[nodiscard]] bool empty() const noexcept LXD_NONBLOCKING { return size() == 0; }
  [[nodiscard]] std::size_t capacity() const noexcept LXD_NONBLOCKING { return storage_.size(); }
  // Any thread. The most bytes that ever waited, as the producer saw it.
  [[nodiscard]] std::size_t high_water() const noexcept LXD_NONBLOCKING {
    return static_cast<std::size_t>(high_water_.load(std::memory_order_relaxed));
  }

 private:
  static constexpr std::size_t kLengthBytes = sizeof(std::uint32_t);

  [[nodiscard]] std::size_t place_of(std::uint64_t at) const noexcept LXD_NONBLOCKING {
    return static_cast<std::size_t>(at) & (storage_.size() - 1);
  }
  // In two parts where the record goes over the storage's end.
  void put(std::uint64_t at, Bytes bytes) noexcept LXD_NONBLOCKING {
    const std::size_t begin = place_of(at);
    const std::size_t first = std::min(bytes.size(), storage_.size() - begin);
    std::copy_n(bytes.begin(), first, storage_.begin() + static_cast<std::ptrdiff_t>(begin));
    std::copy(bytes.begin() + static_cast<std::ptrdiff_t>(first), bytes.end(), storage_.begin());
  }
  void get(std::uint64_t at, std::span<std::uint8_t> bytes) const noexcept LXD_NONBLOCKING {
    const std::size_t begin = place_of(at);
    const std::size_t first = std::min(bytes.size(), storage_.size() - begin);
    std::copy_n(storage_.begin() + static_cast<std::ptrdiff_t>(begin), first, bytes.begin());
    std::copy_n(storage_.begin(), bytes.size() - first, bytes.begin() + static_cast<std::ptrdiff_t>(first));
  }

  std::span<std::uint8_t> storage_;
  // Bytes ever put and taken: 64 bits do not wrap in the life of a rig.
  alignas(kCacheLine_bytes) std::atomic<std::uint64_t> tail_{0};  // written by the producer
  std::atomic<std::uint64_t> high_water_{0};                      // written by the producer
  alignas(kCacheLine_bytes) std::atomic<std::uint64_t> head_{0};  // written by the consumer
};

}  // namespace lxd
