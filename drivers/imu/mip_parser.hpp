// SPDX-License-Identifier: Apache-2.0
// A MicroStrain's bytes in, IMU samples out. Pure: no transport, no allocation; whatever the bytes, every one of them
// is accepted, skipped or still pending.
//
// A packet of IMU data with scaled acceleration and scaled rate is a sample. Its time is the device's own time since it
// started, where the packet has it, else GPS time (since 1980), where the device knows that.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "drivers/imu/mip_format.hpp"
#include "drivers/imu/serial_buffer.hpp"
#include "rt/imu_sample.hpp"

namespace lxd {

struct MipCounts {
  std::uint64_t bytes_accepted = 0;  // of packets whose checksum holds
  std::uint64_t bytes_skipped = 0;   // of anything else
  std::uint64_t frames = 0;          // packets whose checksum holds
  // Refused; the search goes on at the byte after their first.
  std::uint64_t bad_checksum = 0;
  // Sound packets without a sample.
  std::uint64_t bad_field = 0;  // a field's length is not its descriptor's, or ends behind the payload
  std::uint64_t no_imu_fields = 0, non_finite = 0;
};

class MipParser {
 public:
  explicit MipParser(double baud_rate) : buffer_(baud_rate) {}

  // Takes bytes, at least one; says how many. Call next() until it is false, then feed the rest.
  std::size_t feed(std::span<const std::uint8_t> bytes, RigTime received) { return buffer_.append(bytes, received); }
  // False: more bytes are needed.
  bool next(ImuSample& sample);

  [[nodiscard]] const MipCounts& counts() const { return counts_; }
  [[nodiscard]] std::size_t bytes_pending() const { return buffer_.size(); }

 private:
  // Bytes of the packet at the buffer's begin; 0: none is whole yet.
  std::size_t find_packet();
  void skip(std::size_t bytes);
  bool read(std::span<const std::uint8_t> packet, ImuSample& sample);

  SerialBuffer<2 * kMipMaxPacketBytes> buffer_;
  MipCounts counts_;
};

}  // namespace lxd
