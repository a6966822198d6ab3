// SPDX-License-Identifier: Apache-2.0
// Wheel speeds into the frames of a vehicle, by the decoder's own tables.
#pragma once

#include <vector>

#include "drivers/wheel/can_table.hpp"
#include "tools/simulator/wheel/wheel_speeds.hpp"

namespace lxd::sim {

// What the vehicle's own units know when they make a message.
struct VehicleState {
  WheelSpeeds speeds;
  double left_mm = 0, right_mm = 0;  // odometer; wraps as int32
  std::uint32_t counter = 0;         // of messages of this kind
};

// A message that the vehicle sends every period, some time into it.
struct ScheduledMessage {
  std::uint32_t id;
  double phase;  // part of the period
};
std::vector<ScheduledMessage> schedule(WheelProtocol protocol);

// Precondition: the id is one of schedule()'s.
CanFrame encode(const WheelConfig& config, std::uint32_t id, const VehicleState& state);

}  // namespace lxd::sim
