// SPDX-License-Identifier: Apache-2.0
// A sensor's sweeps on the clock of the host that recorded them: what the clock model makes of when packets arrived.
#pragma once

#include <optional>

#include "drivers/replay/sweep_clock.hpp"
#include "drivers/sync/clock_model.hpp"

namespace lxd {

class RigClock final : public SweepClock {
 public:
  explicit RigClock(const ClockModelConfig& config) : model_(config) {}

  void observe(std::int64_t sensor_ns, RigTime received) override { model_.add(sensor_ns, received); }

  // A sweep that does not end after the last one is passed over: "time_repeated", "time_backwards". A step of the
  // sensor's clock is counted ("clock_step").
  bool place(Sweep& sweep, Rejections& rejected) override;

 private:
  ClockModel model_;
  std::optional<RigTime> last_;  // end of the last accepted sweep
};

}  // namespace lxd
