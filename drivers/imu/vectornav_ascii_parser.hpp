// SPDX-License-Identifier: Apache-2.0
// A VectorNav's lines in, IMU samples out. Pure: no transport, no allocation; whatever the bytes, every one of them is
// accepted, skipped or still pending. Lines carry no time of the sensor; what a user has it append to them (a letter
// with digits) is not read.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "drivers/imu/serial_buffer.hpp"
#include "drivers/imu/vectornav_ascii_format.hpp"
#include "rt/imu_sample.hpp"

namespace lxd {

struct VectorNavAsciiCounts {
  std::uint64_t bytes_accepted = 0;  // of lines whose check holds, with their ends
  std::uint64_t bytes_skipped = 0;   // of anything else
  std::uint64_t frames = 0;          // lines whose check holds
  // Refused; the search goes on at the byte after their `$`.
  std::uint64_t bad_checksum = 0, too_long = 0;
  std::uint64_t broken_line = 0;  // another `$`, or a line end without CR or without a check before it
  // Sound lines without a sample.
  std::uint64_t sensor_error = 0;   // VNERR
  std::uint64_t bad_field = 0;      // one of ours with a field that is no number, or with too few
  std::uint64_t no_imu_fields = 0;  // another sentence
};

class VectorNavAsciiParser {
 public:
  explicit VectorNavAsciiParser(double baud_rate) : buffer_(baud_rate) {}

  // Takes bytes, at least one; says how many. Call next() until it is false, then feed the rest.
  std::size_t feed(std::span<const std::uint8_t> bytes, RigTime received) { return buffer_.append(bytes, received); }
  // False: more bytes are needed.
  bool next(ImuSample& sample);

  [[nodiscard]] const VectorNavAsciiCounts& counts() const { return counts_; }
  [[nodiscard]] std::size_t bytes_pending() const { return buffer_.size(); }

 private:
  // Bytes of the line at the buffer's begin; 0: none is whole yet.
  std::size_t find_line();
  // Whether what begins with `$` and ends with LF is sound; counts why not.
  bool line_is_sound(std::string_view line);
  void refuse(std::uint64_t& cause);
  void skip(std::size_t bytes);
  bool read(std::string_view body, ImuSample& sample);

  SerialBuffer<2 * kVectorNavLineMax> buffer_;
  VectorNavAsciiCounts counts_;
};

}  // namespace lxd
