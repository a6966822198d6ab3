// SPDX-License-Identifier: Apache-2.0
// All memory of the runtime comes from one static block, cut once at start-up into named spans. The list of cuts is the
// memory budget that `lxd-slam budget` prints. Start-up thread only; nothing is ever given back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <new>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace lxd {

struct ArenaCut {
  std::string name;
  std::size_t element_bytes = 0;
  std::size_t count = 0;
  std::size_t bytes = 0;  // with the padding before it
};

class Arena {
 public:
  static constexpr std::size_t kAlignment = 64;  // a cache line, and the widest vector register

  explicit Arena(std::span<std::byte> block) : block_(block) {}

  // count value-initialised elements; an empty span when the block is too small (exhausted() then stays true and
  // wanted_bytes() says what would have been enough).
  template <typename T>
  std::span<T> take(std::string_view name, std::size_t count) {
    static_assert(alignof(T) <= kAlignment && std::is_trivially_destructible_v<T>);
    std::byte* const begin = cut(name, sizeof(T), count);
    if (begin == nullptr) return {};
    T* const first = reinterpret_cast<T*>(begin);
    std::uninitialized_value_construct_n(first, count);
    return {std::launder(first), count};
  }

  [[nodiscard]] bool exhausted() const { return wanted_ > block_.size(); }
  [[nodiscard]] std::size_t wanted_bytes() const { return wanted_; }
  [[nodiscard]] std::size_t capacity_bytes() const { return block_.size(); }
  [[nodiscard]] const std::vector<ArenaCut>& cuts() const { return cuts_; }

 private:
  std::byte* cut(std::string_view name, std::size_t element_bytes, std::size_t count) {
    const std::size_t begin = (wanted_ + kAlignment - 1) / kAlignment * kAlignment;
    const std::size_t end = begin + element_bytes * count;
    cuts_.push_back({std::string(name), element_bytes, count, end - wanted_});
    wanted_ = end;
    return end <= block_.size() ? block_.data() + begin : nullptr;
  }

  std::span<std::byte> block_;
  std::size_t wanted_ = 0;
  std::vector<ArenaCut> cuts_;
};

}  // namespace lxd
