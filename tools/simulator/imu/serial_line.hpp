// SPDX-License-Identifier: Apache-2.0
// A serial line into a host, as bytes travel it: one after the other at the baud rate, collected by the host's adapter
// into pieces that know nothing of frames, each stamped when the host gets it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "drivers/replay/serial_log_writer.hpp"
#include "tools/simulator/clock.hpp"
#include "tools/simulator/imu/imu_config.hpp"
#include "tools/simulator/random.hpp"

namespace lxd::sim {

class SerialLine {
 public:
  // The adapter's timer ticks from `start` on, with a phase drawn from `random`, as do the delays of the pieces.
  SerialLine(const SerialLineConfig& config, const SensorClock& clock, RigTime start, Random random,
             SerialLogWriter& log);

  // The sensor has the bytes ready at `ready`; they wait for those before them. Calls are in the order of time.
  Status send(RigTime ready, std::span<const std::uint8_t> bytes);
  // What the adapter still holds, at its next tick.
  Status finish();

 private:
  Status take(RigTime arrived, std::uint8_t byte);
  Status hand_over(RigTime at);

  SensorClock clock_;
  Random random_;
  SerialLogWriter& log_;
  Duration byte_time_, timer_;
  std::size_t capacity_;
  RigTime free_;       // the line, from then on
  RigTime tick_;       // the adapter's next
  RigTime last_read_;  // receive stamps of one port never go back
  std::vector<std::uint8_t> held_;
};

}  // namespace lxd::sim
