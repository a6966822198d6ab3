// SPDX-License-Identifier: Apache-2.0
// A WitMotion's bytes in, IMU samples out. Pure: no transport, no allocation; whatever the bytes, every one of them is
// accepted, skipped or still pending.
//
// The module sends a burst of frames for each sample: time (where that is switched on), acceleration, rate, and more
// that is not used here. Rate makes a sample with the acceleration directly before it. The sample's time is when the
// first frame of its burst began to be sent.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "drivers/imu/serial_buffer.hpp"
#include "drivers/imu/witmotion_format.hpp"
#include "rt/imu_sample.hpp"

namespace lxd {

struct WitMotionCounts {
  std::uint64_t bytes_accepted = 0;  // of frames whose checksum holds
  std::uint64_t bytes_skipped = 0;   // of anything else
  std::uint64_t frames = 0;          // whose checksum holds
  // Refused; the search goes on at the byte after their 0x55.
  std::uint64_t bad_checksum = 0, unknown_id = 0;
  // Sound frames that are not used.
  std::uint64_t no_imu_fields = 0;                         // another id
  std::uint64_t orphan_acceleration = 0, orphan_rate = 0;  // the other half is missing
  std::uint64_t bad_time = 0;                              // no date
};

class WitMotionParser {
 public:
  explicit WitMotionParser(double baud_rate) : buffer_(baud_rate) {}

  // Takes bytes, at least one; says how many. Call next() until it is false, then feed the rest.
  std::size_t feed(std::span<const std::uint8_t> bytes, RigTime received) { return buffer_.append(bytes, received); }
  // False: more bytes are needed.
  bool next(ImuSample& sample);

  [[nodiscard]] const WitMotionCounts& counts() const { return counts_; }
  [[nodiscard]] std::size_t bytes_pending() const { return buffer_.size(); }

 private:
  // What of a burst has come.
  struct Burst {
    RigTime sent;
    std::optional<std::int64_t> sensor_ns;
    std::optional<Eigen::Vector3d> accel_mps2;
  };
  bool frame_is_sound();
  bool take_frame(ImuSample& sample);
  void take_time(std::span<const std::uint8_t> frame);
  void take_acceleration(std::span<const std::uint8_t> frame);
  bool take_rate(std::span<const std::uint8_t> frame, ImuSample& sample);
  void drop_burst();
  void skip(std::size_t bytes);

  static constexpr std::size_t kBufferBytes = 512;
  SerialBuffer<kBufferBytes> buffer_;
  std::optional<Burst> burst_;
  WitMotionCounts counts_;
};

}  // namespace lxd
