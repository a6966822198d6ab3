// SPDX-License-Identifier: Apache-2.0
#include "board/wheel_table.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace lxd {
namespace {

const Vehicle* vehicle_of(const WheelRig& rig) {
  const auto* const found = std::ranges::find(kVehicles, rig.protocol, &Vehicle::name);
  return found == kVehicles.end() ? nullptr : found;
}

std::string signal_text(const CanSignal& signal) {
  std::string text = fmt::format("{{role: {}, start_bit: {}, bits: {}, byte_order: {}, sign: {}, scale: {}, offset: {}",
                                 kCanRoleNames[static_cast<std::size_t>(signal.role)], signal.start_bit, signal.bits,
                                 signal.order == CanByteOrder::intel ? "intel" : "motorola",
                                 signal.is_signed ? "signed" : "unsigned", signal.scale, signal.offset);
  if (signal.fault_bit != CanSignal::kNoFaultBit) text += fmt::format(", fault_bit: {}", signal.fault_bit);
  return text + "}";
}

}  // namespace

std::vector<CanMessage> wheel_messages(const WheelRig& rig) {
  if (const Vehicle* const vehicle = vehicle_of(rig)) {
    const auto table = vehicle->messages();
    return {table.begin(), table.end()};
  }
  std::vector<CanMessage> messages;
  for (const WheelMessageRig& message : rig.messages)
    messages.push_back({message.id, "", message.length, message.checksum, message.signals, message.extended});
  return messages;
}

WheelSource wheel_source(const WheelRig& rig) {
  const auto* const named = std::ranges::find(kWheelKinematicsNames, rig.kinematics);
  if (named != kWheelKinematicsNames.end()) return static_cast<WheelSource>(named - kWheelKinematicsNames.begin());
  const Vehicle* const vehicle = vehicle_of(rig);
  return vehicle != nullptr ? vehicle->source : WheelSource::rear_wheels;
}

WheelDecoderConfig wheel_decoder_config(const WheelRig& rig, std::span<const CanMessage> messages) {
  WheelDecoderConfig config{messages, wheel_source(rig), rig.track_m};
  config.wheelbase_m = rig.wheelbase_m;
  return config;
}

std::string wheel_messages_text(const WheelRig& rig) {
  std::string text;
  for (const WheelMessageRig& message : rig.messages) {
    text += fmt::format("    - id: {:#05X}\n      extended: {}\n      length: {}\n      checksum: {}\n      signals:\n",
                        message.id, message.extended, message.length,
                        kCanChecksumNames[static_cast<std::size_t>(message.checksum)]);
    for (const CanSignal& signal : message.signals) text += fmt::format("        - {}\n", signal_text(signal));
  }
  return text;
}

}  // namespace lxd
