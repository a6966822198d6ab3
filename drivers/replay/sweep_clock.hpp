// SPDX-License-Identifier: Apache-2.0
// How a capture's sweeps come onto the rig's clock: what a packet source asks, whatever the answer is made of.
#pragma once

#include <cstdint>
#include <optional>

#include "drivers/replay/rejections.hpp"
#include "rt/sweep.hpp"

namespace lxd {

class SweepClock {
 public:
  virtual ~SweepClock() = default;

  // A packet whose last sample was taken at sensor_ns (the sensor's clock) reached the host at `received`.
  virtual void observe(std::int64_t sensor_ns, RigTime received) = 0;

  // A pulse at a whole second of the sensor's clock; clocks that do not go by pulses do not listen.
  virtual void add_pulse(RigTime edge) { (void)edge; }

  // Moves the sweep from the sensor's time to rig time. False, and counted: it cannot be placed in order.
  virtual bool place(Sweep& sweep, Rejections& rejected) = 0;

  // Rig time of an instant of the sensor's; nothing while too little of the sensor has been heard.
  [[nodiscard]] virtual std::optional<RigTime> rig_time(RigTime sensor) const = 0;
};

}  // namespace lxd
