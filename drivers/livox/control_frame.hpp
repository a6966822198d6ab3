// SPDX-License-Identifier: Apache-2.0
// Control frames: bytes in, a frame or a counted refusal out, and the other way. Pure, allocates nothing.
#pragma once

#include <cstdint>
#include <span>

#include "drivers/livox/control_format.hpp"

namespace lxd {

struct LivoxControlFrame {
  std::uint32_t sequence = 0;  // an ack has its command's
  std::uint16_t command = 0;   // LivoxCommand, or one that is not known here
  LivoxControlKind kind = LivoxControlKind::kCommand;
  LivoxControlSender sender = LivoxControlSender::kHost;
  std::span<const std::uint8_t> data;  // points into the datagram

  [[nodiscard]] bool is(LivoxCommand wanted, LivoxControlKind wanted_kind) const {
    return command == static_cast<std::uint16_t>(wanted) && kind == wanted_kind;
  }
};

struct LivoxControlCounts {
  std::uint64_t frames = 0;      // accepted
  std::uint64_t bad_size = 0;    // shorter than a header, or not as long as the header says
  std::uint64_t bad_start = 0;   // start byte or version
  std::uint64_t bad_crc = 0;     // of header or data
  std::uint64_t bad_kind = 0;    // neither command nor ack, or of neither host nor sensor
  std::uint64_t bad_values = 0;  // of the data, where a reader of control_messages.hpp refused them: count_bad_values()
};

class LivoxControlParser {
 public:
  // False: refused and counted; `frame` is then without meaning.
  bool parse(std::span<const std::uint8_t> datagram, LivoxControlFrame& frame);
  void count_bad_values() { ++counts_.bad_values; }

  [[nodiscard]] const LivoxControlCounts& counts() const { return counts_; }

 private:
  bool accept(std::span<const std::uint8_t> datagram);

  LivoxControlCounts counts_;
};

// Writes the frame and gives the bytes used; empty: `buffer` has no room for it, or it is longer than
// kLivoxControlMaxBytes. The frame's data may not overlap the buffer.
std::span<const std::uint8_t> encode_livox_control(const LivoxControlFrame& frame, std::span<std::uint8_t> buffer);

}  // namespace lxd
