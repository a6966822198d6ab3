// SPDX-License-Identifier: Apache-2.0
// What a scenario says of the pulse per second and of the microcontroller that triggers sensors.
#pragma once

#include <string>
#include <vector>

#include "board/yaml_section.hpp"
#include "tools/simulator/clock.hpp"

namespace lxd::sim {

// A line that the microcontroller pulses: a camera's trigger (at its exposures), a LiDAR's or an IMU's sync.
struct TriggerLine {
  std::string name;  // "camera0"
  std::vector<double> times_s;
  double pulse_s = 1e-3;
};

struct SyncConfig {
  double jitter_s = 3e-6;              // mean of the interrupt's exponential delay
  double missing_probability = 1e-3;   // of each edge
  double spurious_probability = 1e-3;  // of one more edge in a second of the pulse
  double pulse_s = 0.1;
  std::vector<TriggerLine> triggers;  // given by whoever knows the sensors; no keys
  ClockConfig clock;                  // of the pulse (UTC) against the host; latency is that of the edges
};

void read_keys(YamlSection& section, SyncConfig& config);

}  // namespace lxd::sim
