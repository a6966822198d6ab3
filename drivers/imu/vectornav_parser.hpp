// SPDX-License-Identifier: Apache-2.0
// A VectorNav's bytes in, IMU samples out. Pure: no transport, no allocation; whatever the bytes, every one of them is
// accepted, skipped or still pending.
#pragma once

#include <cstdint>
#include <span>

#include "drivers/imu/serial_buffer.hpp"
#include "drivers/imu/vectornav_format.hpp"
#include "rt/imu_sample.hpp"

namespace lxd {

struct VectorNavCounts {
  std::uint64_t bytes_accepted = 0;  // of frames whose CRC holds
  std::uint64_t bytes_skipped = 0;   // of anything else
  std::uint64_t frames = 0;          // whose CRC holds
  // Headers and frames refused; the search goes on at the byte after their 0xFA.
  std::uint64_t bad_crc = 0, too_long = 0, unknown_field = 0;
  // Sound frames without a sample.
  std::uint64_t no_imu_fields = 0, non_finite = 0;
};

class VectorNavParser {
 public:
  explicit VectorNavParser(double baud_rate) : buffer_(baud_rate) {}

  // Takes bytes, at least one; says how many. Call next() until it is false, then feed the rest.
  std::size_t feed(std::span<const std::uint8_t> bytes, RigTime received) { return buffer_.append(bytes, received); }
  // False: more bytes are needed.
  bool next(ImuSample& sample);

  [[nodiscard]] const VectorNavCounts& counts() const { return counts_; }
  [[nodiscard]] std::size_t bytes_pending() const { return buffer_.size(); }

 private:
  // The frame at the buffer's begin: its bytes, none when it is not whole yet or was refused (then a byte was skipped).
  enum class Frame { kIncomplete, kRefused, kSound };
  Frame find_frame(VectorNavLayout& layout);
  Frame refuse(std::uint64_t& cause);
  void skip(std::size_t bytes);
  bool read(const VectorNavLayout& layout, ImuSample& sample);

  SerialBuffer<2 * kVectorNavMaxFrameBytes> buffer_;
  VectorNavCounts counts_;
};

}  // namespace lxd
