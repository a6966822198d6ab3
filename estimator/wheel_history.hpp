// SPDX-License-Identifier: Apache-2.0
// The newest readings of the wheels. Real-time thread only; memory from the arena.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <span>

#include "rt/arena.hpp"
#include "rt/time.hpp"

namespace lxd {

// Of the wheel frame at an instant of the rig's clock.
struct WheelReading {
  RigTime t;
  double speed_mps = 0;       // forward
  double yaw_rate_radps = 0;  // left turns positive
};

// What wheels say of a time: readings summed up over it.
struct WheelWay {
  double way_m = 0, turn_rad = 0;
  double speed_change_mps = 0, rate_change_radps = 0;  // from its begin to its end
  double span_s = 0;
  std::uint32_t readings = 0;
};

class WheelHistory {
 public:
  static constexpr std::uint32_t kReadings = 1024;

  explicit WheelHistory(Arena& arena) : readings_(arena.take<WheelReading>("wheel readings", kReadings)) {}

  // Readings are of an instant so much before their stamps: all times below but that of add() are instants.
  void set_delay(Duration delay) { delay_ = delay; }
  [[nodiscard]] Duration delay() const { return delay_; }

  // One that is no number, or not after the last, is left out.
  void add(const WheelReading& reading) noexcept;
  void clear() { count_ = 0; }

  // take(reading, its t an instant) of all after `after`, in order, until it returns false.
  template <typename F>
  void for_each(RigTime after, F&& take) const {
    for (std::uint32_t back = since(after); back > 0; --back) {
      WheelReading reading = at(back);
      reading.t = reading.t - delay_;
      if (!take(reading)) return;
    }
  }

  // None: readings do not reach from `from` to `to`, or have a hole.
  [[nodiscard]] std::optional<WheelWay> way(RigTime from, RigTime to) const noexcept;

 private:
  // The last but `back` - 1.
  [[nodiscard]] const WheelReading& at(std::uint32_t back) const { return readings_[(count_ - back) % kReadings]; }
  [[nodiscard]] std::uint32_t since(RigTime after) const noexcept;  // how many readings are after it

  std::span<WheelReading> readings_;  // a ring
  std::uint64_t count_ = 0;           // ever taken
  Duration delay_;
};

}  // namespace lxd
