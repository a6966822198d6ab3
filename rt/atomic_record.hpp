// SPDX-License-Identifier: Apache-2.0
// A trivially copyable value that one thread may overwrite while another copies it. A copy that was overtaken is
// detected, never used. (A sequence lock, H.-J. Boehm, "Can seqlocks get along with programming language memory
// models?", MSPC 2012; with release/acquire words in place of fences, so that ThreadSanitizer can follow it.)
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "rt/nonblocking.hpp"

namespace lxd {

template <typename T>
class AtomicRecord {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  // Writer thread only; number is greater than every number stored before.
  void store(std::uint64_t number, const T& value) noexcept LXD_NONBLOCKING {
    Words words{};
    std::memcpy(words.data(), &value, sizeof(T));
    version_.store(2 * number + 1, std::memory_order_relaxed);  // odd: being written
    // Release: who sees one of these words also sees the odd version before it.
    for (std::size_t i = 0; i < kWords; ++i) words_[i].store(words[i], std::memory_order_release);
    version_.store(2 * number + 2, std::memory_order_release);
  }

  // Any thread. False, with value untouched, unless it held the value stored as number from begin to end.
  [[nodiscard]] bool load(std::uint64_t number, T& value) const noexcept LXD_NONBLOCKING {
    if (version_.load(std::memory_order_acquire) != 2 * number + 2) return false;
    Words words;
    // Acquire: the version below is read after these words.
    for (std::size_t i = 0; i < kWords; ++i) words[i] = words_[i].load(std::memory_order_acquire);
    if (version_.load(std::memory_order_relaxed) != 2 * number + 2) return false;
    std::memcpy(static_cast<void*>(&value), words.data(), sizeof(T));
    return true;
  }

 private:
  static constexpr std::size_t kWords = (sizeof(T) + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t);
  using Words = std::array<std::uint64_t, kWords>;

  std::atomic<std::uint64_t> version_{0};
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

}  // namespace lxd
