// SPDX-License-Identifier: Apache-2.0
// The bytes of a serial line that are not yet a frame, with the latest instant at which each can have arrived: a line
// carries one byte after the other, so n bytes before the last one lie n byte times before it, whatever the host's
// driver collected in between.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>

#include "rt/time.hpp"

namespace lxd {

template <std::size_t kCapacity>
class SerialBuffer {
 public:
  // 8N1. Precondition: baud_rate > 0.
  explicit SerialBuffer(double baud_rate) : byte_time_(Duration::from_seconds(kBitsPerByte / baud_rate)) {}

  // Takes what there is room for, and says how much that is; `received` is the host's stamp of all the bytes.
  std::size_t append(std::span<const std::uint8_t> bytes, RigTime received) {
    std::memmove(bytes_.data(), bytes_.data() + begin_, size());
    end_ -= begin_;
    begin_ = 0;
    const std::size_t taken = std::min(bytes.size(), kCapacity - end_);
    std::copy_n(bytes.begin(), taken, bytes_.begin() + static_cast<std::ptrdiff_t>(end_));
    end_ += taken;
    received_ = received;
    last_arrival_ = received - byte_time_ * static_cast<std::int64_t>(bytes.size() - taken);
    return taken;
  }

  [[nodiscard]] std::span<const std::uint8_t> view() const { return std::span(bytes_).subspan(begin_, size()); }
  [[nodiscard]] std::size_t size() const { return end_ - begin_; }
  // Precondition: count <= size().
  void drop(std::size_t count) { begin_ += count; }

  [[nodiscard]] RigTime received() const { return received_; }  // of the last append
  // When view()[i] began to be sent, at the latest. Precondition: i < size().
  [[nodiscard]] RigTime sent(std::size_t i) const {
    return last_arrival_ - byte_time_ * static_cast<std::int64_t>(size() - i);
  }

 private:
  static constexpr double kBitsPerByte = 10;  // a start and a stop bit around eight
  std::array<std::uint8_t, kCapacity> bytes_{};
  std::size_t begin_ = 0, end_ = 0;
  RigTime received_, last_arrival_;
  Duration byte_time_;
};

}  // namespace lxd
