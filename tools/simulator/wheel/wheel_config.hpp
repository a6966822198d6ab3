// SPDX-License-Identifier: Apache-2.0
// What a scenario says of the wheels.
#pragma once

#include <string>

#include "board/yaml_section.hpp"
#include "rt/pose.hpp"
#include "tools/simulator/clock.hpp"

namespace lxd::sim {

enum class WheelProtocol { agilex, toyota };

struct WheelConfig {
  WheelProtocol protocol = WheelProtocol::agilex;
  double rate_hz = 50;            // of each message
  double track_m = 0.58;          // between left and right wheels
  double wheelbase_m = 2.66;      // Toyota: from the rear wheels to the front ones
  double wheel_radius_m = 0.165;  // for the motors' rpm
  double scale_error = 0;         // of the speeds: 0.01 shows 1 % too much, as worn tyres do
  double speed_sigma_mps = 0.01;  // white, of each wheel and message
  double slip_per_minute = 0;     // stretches in which a side, or both, turns too fast
  double slip_s = 0.5;            // their length
  double slip_part = 0.15;        // by how much too fast
  double other_frames_hz = 100;   // what else is on the bus
  double odometer_start_mm = 0;   // what the counts show at the start
  bool csv = false;               // wheel.csv of the generic folder as well
  std::string interface = "can0";
  Pose T_body_sensor;  // of the wheel frame: x forward, between the rear (or only) wheels
  ClockConfig clock;   // jitter_s is not used: CAN frames carry no stamps
};

void read_keys(YamlSection& section, WheelConfig& config);

}  // namespace lxd::sim
