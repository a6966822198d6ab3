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
  toyota,       // last byte: sum of length, the id's bytes and all bytes before it
  honda,        // low four bits of the last byte: 8 less the sum of all other half bytes of id and data
  sum,          // last byte: sum of all bytes before it
  exclusive_or  // last byte: of all bytes before it
};

// As rig files name them, in the enumeration's order.
inline constexpr std::array<std::string_view, 5> kCanChecksumNames{"none", "toyota", "honda", "sum", "xor"};

struct CanMessage {
  std::uint32_t id = 0;
  std::string_view name;
  std::uint8_t length = 0;
  CanChecksum checksum = CanChecksum::none;
  std::span<const CanSignal> signals;
  bool extended = false;  // its id has 29 bits
};

// AgileX protocol V2 (Scout, Hunter, Ranger, Bunker, Tracer).
std::span<const CanMessage> agilex_messages();
// Toyota, cars of 2016 and later with Safety Sense.
std::span<const CanMessage> toyota_messages();
// Honda, cars with Sensing.
std::span<const CanMessage> honda_messages();
// Nissan Leaf.
std::span<const CanMessage> nissan_messages();

// The message of an id of 11 or, extended, of 29 bits, or null.
const CanMessage* find_message(std::span<const CanMessage> table, std::uint32_t id, bool extended = false);
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
