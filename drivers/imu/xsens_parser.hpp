// SPDX-License-Identifier: Apache-2.0
// An Xsens' bytes in, IMU samples out. Pure: no transport, no allocation; whatever the bytes, every one of them is
// accepted, skipped or still pending.
//
// A message with acceleration and rate of turn is a sample. The device counts its time in 32 bits of 100 us, which are
// begun anew after five days: here they go on.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "drivers/imu/serial_buffer.hpp"
#include "drivers/imu/xsens_format.hpp"
#include "rt/imu_sample.hpp"

namespace lxd {

struct XsensCounts {
  std::uint64_t bytes_accepted = 0;  // of frames whose checksum holds
  std::uint64_t bytes_skipped = 0;   // of anything else
  std::uint64_t frames = 0;          // whose checksum holds
  // Refused; the search goes on at the byte after their 0xFA.
  std::uint64_t bad_checksum = 0, too_long = 0, bad_bus = 0;
  // Sound frames without a sample.
  std::uint64_t bad_field = 0;  // an item's size is not its id's, or it ends behind the data
  std::uint64_t no_imu_fields = 0, non_finite = 0;
};

class XsensParser {
 public:
  explicit XsensParser(double baud_rate) : buffer_(baud_rate) {}

  // Takes bytes, at least one; says how many. Call next() until it is false, then feed the rest.
  std::size_t feed(std::span<const std::uint8_t> bytes, RigTime received) { return buffer_.append(bytes, received); }
  // False: more bytes are needed.
  bool next(ImuSample& sample);

  [[nodiscard]] const XsensCounts& counts() const { return counts_; }
  [[nodiscard]] std::size_t bytes_pending() const { return buffer_.size(); }

 private:
  enum class Frame { kIncomplete, kRefused, kSound };
  Frame find_frame(XsensHeader& header);
  Frame refuse(std::uint64_t& cause);
  void skip(std::size_t bytes);
  bool read(std::span<const std::uint8_t> frame, const XsensHeader& header, ImuSample& sample);
  std::int64_t unwrapped_ns(std::uint32_t ticks);

  SerialBuffer<2 * kXsensMaxFrameBytes> buffer_;
  std::optional<std::int64_t> ticks_;  // of the last sample
  XsensCounts counts_;
};

}  // namespace lxd
