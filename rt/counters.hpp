// SPDX-License-Identifier: Apache-2.0
// Events by cause (drops, rejects, resets), one counter for each value of an enum. A report names them; the real-time
// path only adds.
#pragma once

#include <array>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "rt/nonblocking.hpp"

namespace lxd {

// Cause: an enum whose values are 0, 1, … and whose last enumerator, kCount, counts them.
template <typename Cause>
class Counters {
  static_assert(std::is_enum_v<Cause>);

 public:
  static constexpr std::size_t kSize = static_cast<std::size_t>(Cause::kCount);

  // Any thread. Precondition: cause != kCount.
  void add(Cause cause, std::uint64_t events = 1) noexcept LXD_NONBLOCKING {
    assert(static_cast<std::size_t>(cause) < kSize);
    counts_[static_cast<std::size_t>(cause)].fetch_add(events, std::memory_order_relaxed);
  }

  // Any thread; counters are read one by one, not as one snapshot.
  [[nodiscard]] std::uint64_t operator[](Cause cause) const noexcept LXD_NONBLOCKING {
    assert(static_cast<std::size_t>(cause) < kSize);
    return counts_[static_cast<std::size_t>(cause)].load(std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint64_t total() const noexcept LXD_NONBLOCKING {
    std::uint64_t sum = 0;
    for (const auto& count : counts_) sum += count.load(std::memory_order_relaxed);
    return sum;
  }

 private:
  std::array<std::atomic<std::uint64_t>, kSize> counts_{};
};

}  // namespace lxd
