// SPDX-License-Identifier: Apache-2.0
// A serial IMU's bytes as samples, whatever its protocol, and its samples on the rig's clock: the same objects below a
// recorded line and below a live port.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <variant>
#include <vector>

#include "drivers/imu/imu_protocol.hpp"
#include "drivers/imu/mip_parser.hpp"
#include "drivers/imu/vectornav_ascii_parser.hpp"
#include "drivers/imu/vectornav_parser.hpp"
#include "drivers/imu/witmotion_parser.hpp"
#include "drivers/imu/xsens_parser.hpp"
#include "drivers/replay/rejections.hpp"
#include "drivers/sync/clock_model.hpp"
#include "drivers/sync/held_pulses.hpp"
#include "rt/imu_sample.hpp"

namespace lxd {

class ImuStream {
 public:
  // Precondition: baud_rate > 0.
  ImuStream(ImuProtocol protocol, double baud_rate);

  // Takes what has room, and gives how much that was; all, after next() was false.
  std::size_t feed(std::span<const std::uint8_t> bytes, RigTime received) {
    return std::visit([&](auto& parser) { return parser.feed(bytes, received); }, parser_);
  }
  // False: more bytes are needed.
  bool next(ImuSample& sample) {
    return std::visit([&](auto& parser) { return parser.next(sample); }, parser_);
  }

  // Since the start, by cause.
  [[nodiscard]] Rejections rejected() const;

 private:
  std::variant<VectorNavParser, VectorNavAsciiParser, WitMotionParser, MipParser, XsensParser> parser_;
};

class ImuClock {
 public:
  // pulses: all those of a recording, if the sensor's clock goes by them.
  explicit ImuClock(std::vector<RigTime> pulses = {}) : model_(ClockModelConfig{}), pulses_(std::move(pulses)) {}

  // A pulse at a whole second of the sensor's clock.
  void add_pulse(RigTime edge) { pulses_.add(edge); }

  // Sets `t` to the sample's instant on the rig's clock; a sample that says no time of its own keeps that of its
  // arrival. False: its time does not belong to the sensor's clock so far.
  bool place(ImuSample& sample);

  [[nodiscard]] const ClockCounts& counts() const { return model_.counts(); }

 private:
  ClockModel model_;
  HeldPulses pulses_;
};

}  // namespace lxd
