// SPDX-License-Identifier: Apache-2.0
// A sensor's sweeps on the clock of the host that recorded them: what the clock model makes of when packets arrived.
#pragma once

#include <optional>
#include <utility>
#include <vector>

#include "drivers/replay/sweep_clock.hpp"
#include "drivers/sync/clock_model.hpp"
#include "drivers/sync/held_pulses.hpp"

namespace lxd {

class RigClock final : public SweepClock {
 public:
  // pulses: all those of a recording, if the sensor's clock goes by them.
  explicit RigClock(const ClockModelConfig& config, std::vector<RigTime> pulses = {})
      : model_(config), pulses_(std::move(pulses)) {}

  void observe(std::int64_t sensor_ns, RigTime received) override;
  void add_pulse(RigTime edge) override { pulses_.add(edge); }
  [[nodiscard]] const ClockCounts& counts() const { return model_.counts(); }

  // A sweep that does not end after the last one is passed over: "time_repeated", "time_backwards". A step of the
  // sensor's clock is counted ("clock_step"); the sweep over which it happened is on the clock before or after it,
  // whichever puts its end nearer to the packets that came last.
  bool place(Sweep& sweep, Rejections& rejected) override;

  [[nodiscard]] std::optional<RigTime> rig_time(RigTime sensor) const override {
    return newest_ ? std::optional(placed(sensor)) : std::nullopt;
  }

 private:
  [[nodiscard]] RigTime placed(RigTime sensor) const;  // once a packet was received

  ClockModel model_;
  HeldPulses pulses_;
  std::optional<RigTime> newest_;   // when the last packet was received
  std::optional<RigTime> stepped_;  // and the one that made the last step known
  Duration undo_;                   // of that step: from what the model gives to what it gave before
  std::optional<RigTime> last_;     // end of the last accepted sweep
};

}  // namespace lxd
