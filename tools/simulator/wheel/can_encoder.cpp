// SPDX-License-Identifier: Apache-2.0
// See can_encoder.hpp.
#include "tools/simulator/wheel/can_encoder.hpp"

#include <cmath>
#include <numbers>

namespace lxd::sim {
namespace {

// Motor fast state of an AgileX (ugv_sdk): i16 rpm, i16 current 0.1 A, i32 pulses. The decoder has no use for it.
constexpr std::uint32_t kAgilexMotorLeft = 0x251, kAgilexMotorRight = 0x252;
constexpr CanSignal kMotorRpm{"rpm", CanRole::other, 7, 16, CanByteOrder::motorola, true, 1, 0, CanSignal::kNoFaultBit};

void set(CanFrame& frame, const CanMessage& message, std::string_view signal, double value) {
  find_signal(message, signal)->set_value(frame.data, value);
}

// Counts go on from the greatest int32 to the least.
void set_way(CanFrame& frame, const CanMessage& message, std::string_view signal, double way_mm) {
  find_signal(message, signal)->set_raw(frame.data, std::llround(way_mm));
}

CanFrame empty_frame(std::uint32_t id) {
  CanFrame frame;
  frame.id = id;
  frame.length = kCanMaxData;
  return frame;
}

CanFrame motor(const WheelConfig& config, std::uint32_t id, const VehicleState& state) {
  constexpr double kMinute_s = 60;
  CanFrame frame = empty_frame(id);
  const double speed_mps = id == kAgilexMotorLeft ? state.speeds.left_mps : state.speeds.right_mps;
  kMotorRpm.set_value(frame.data, speed_mps / (2 * std::numbers::pi * config.wheel_radius_m) * kMinute_s);
  return frame;
}

CanFrame agilex(const WheelConfig& config, const CanMessage& message, const VehicleState& state) {
  CanFrame frame = empty_frame(message.id);
  if (message.name == "motion_state") {
    set(frame, message, "linear_velocity", state.speeds.speed_mps());
    set(frame, message, "angular_velocity", state.speeds.wheel_yaw_rate_radps(config.track_m));
  } else {
    set_way(frame, message, "left_wheel", state.left_mm);
    set_way(frame, message, "right_wheel", state.right_mm);
  }
  return frame;
}

CanFrame toyota(const CanMessage& message, const VehicleState& state) {
  CanFrame frame = empty_frame(message.id);
  if (message.name == "WHEEL_SPEEDS") {
    set(frame, message, "WHEEL_SPEED_FR", state.speeds.front_right_mps);
    set(frame, message, "WHEEL_SPEED_FL", state.speeds.front_left_mps);
    set(frame, message, "WHEEL_SPEED_RR", state.speeds.right_mps);
    set(frame, message, "WHEEL_SPEED_RL", state.speeds.left_mps);
  } else if (message.name == "SPEED") {
    set(frame, message, "SPEED", std::abs(state.speeds.speed_mps()));
    find_signal(message, "ENCODER")->set_raw(frame.data, state.counter & 0xFFU);
  } else {
    set(frame, message, "YAW_RATE", state.speeds.yaw_rate_radps);
  }
  set_checksum(message, frame.data);
  return frame;
}

}  // namespace

std::vector<ScheduledMessage> schedule(WheelProtocol protocol) {
  if (protocol == WheelProtocol::toyota) return {{0x0AA, 0}, {0x0B4, 0.15}, {0x024, 0.3}};
  return {{0x221, 0}, {0x311, 0.1}, {kAgilexMotorLeft, 0.2}, {kAgilexMotorRight, 0.25}};
}

CanFrame encode(const WheelConfig& config, std::uint32_t id, const VehicleState& state) {
  if (id == kAgilexMotorLeft || id == kAgilexMotorRight) return motor(config, id, state);
  if (config.protocol == WheelProtocol::toyota) return toyota(*find_message(toyota_messages(), id), state);
  return agilex(config, *find_message(agilex_messages(), id), state);
}

}  // namespace lxd::sim
