// SPDX-License-Identifier: Apache-2.0
// Which frames a vehicle sends and what is in them: a row a signal. A new vehicle is a new table.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "drivers/wheel/can_signal.hpp"

namespace lxd {

enum class CanChecksum : std::uint8_t {
  none,
  toyota  // last byte: sum of length, the id's bytes and all bytes before it
};

struct CanMessage {
  std::uint32_t id = 0;
  std::string_view name;
  std::uint8_t length = 0;
  CanChecksum checksum = CanChecksum::none;
  std::span<const CanSignal> signals;
};

// AgileX protocol V2 (Scout, Hunter, Ranger, Bunker, Tracer).
std::span<const CanMessage> agilex_messages();
// Toyota, cars of 2016 and later with Safety Sense.
std::span<const CanMessage> toyota_messages();

// The message of an 11-bit id, or null.
const CanMessage* find_message(std::span<const CanMessage> table, std::uint32_t id);
const CanSignal* find_signal(const CanMessage& message, std::string_view name);

// Whether the frame's checksum is right; true when the message has none. Precondition: the frame has message.length.
bool checksum_holds(const CanMessage& message, const CanData& data);
void set_checksum(const CanMessage& message, CanData& data);

// A decoded signal: unknown when the frame does not have it or its fault bit is set.
struct CanValue {
  const CanSignal* signal = nullptr;
  std::int64_t raw = 0;

  [[nodiscard]] bool known() const { return signal != nullptr; }
  // Precondition: known().
  [[nodiscard]] double value() const { return signal->to_value(raw); }
};

struct CanValues {
  std::array<CanValue, static_cast<std::size_t>(CanRole::kCount)> by_role{};
  bool fault = false;  // one of the fault bits was set

  [[nodiscard]] const CanValue& operator[](CanRole role) const { return by_role[static_cast<std::size_t>(role)]; }
};

// Precondition: the frame has message.length.
CanValues decode_signals(const CanMessage& message, const CanData& data);

}  // namespace lxd
