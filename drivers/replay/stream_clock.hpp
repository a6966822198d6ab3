// SPDX-License-Identifier: Apache-2.0
// A sensor's own clock laid onto the rig's, sweep by sweep, so that rig time only ever increases: also when the sensor
// restarts and counts from zero again, which is an event and not the end of the recording.
#pragma once

#include <optional>

#include "drivers/replay/sweep_clock.hpp"

namespace lxd {

class StreamClock final : public SweepClock {
 public:
  // period: nominal, of a sweep.
  explicit StreamClock(Duration period) : period_(period) {}

  void observe(std::int64_t, RigTime) override {}  // when packets arrived says nothing of another host's capture

  // Moves the sweep from the sensor's time to rig time, whose zero is the first sweep's begin. False, and counted: the
  // last accepted end again ("time_repeated"), or an earlier one ("time_backwards"). When kStepSweeps earlier ones
  // follow each other in order, the clock has stepped ("clock_step"): the last of them is accepted, and time goes on
  // as if the first of them had ended one period after the last sweep before the step.
  bool place(Sweep& sweep, Rejections& rejected) override;

  [[nodiscard]] std::optional<RigTime> rig_time(RigTime sensor) const override {
    return last_ ? std::optional(sensor + to_rig_) : std::nullopt;
  }

 private:
  static constexpr int kStepSweeps = 3;  // one or two may be damaged packets; three in order are a clock

  bool in_order(RigTime end, Rejections& rejected);
  bool has_stepped(RigTime end);

  Duration period_;
  std::optional<RigTime> last_;  // end of the last accepted sweep; as all below, in the sensor's time
  Duration to_rig_;
  RigTime first_earlier_, last_earlier_;  // ends, of the earlier sweeps under way
  int earlier_ = 0;
};

}  // namespace lxd
