// SPDX-License-Identifier: Apache-2.0
// A signal of a CAN frame, in the terms of a DBC file. The same table entry reads frames (decoder) and writes them
// (simulator, tests).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "drivers/wheel/can_frame.hpp"

namespace lxd {

// What a signal means to the wheel decoder. Units: m, m/s, rad/s.
enum class CanRole : std::uint8_t {
  other,  // decoded for display only
  speed,  // forward
  yaw_rate,
  front_right,  // wheel speeds
  front_left,
  rear_right,
  rear_left,
  odometer_left,  // way of a wheel; wraps where its bits end
  odometer_right,
  steering_angle,  // of a wheel midway between the steered ones, left turns positive
  kCount
};

// As rig files name them, in the enumeration's order.
inline constexpr std::array<std::string_view, static_cast<std::size_t>(CanRole::kCount)> kCanRoleNames{
    "other",      "speed",     "yaw_rate",      "front_right",    "front_left",
    "rear_right", "rear_left", "odometer_left", "odometer_right", "steering_angle"};

// `intel` ("@1" in a DBC): the start bit is the least significant. `motorola` ("@0"): it is the most significant, and
// the signal goes on downwards through its byte, then from bit 7 of the next. Bits count byte * 8 + bit in byte.
enum class CanByteOrder : std::uint8_t { intel, motorola };

struct CanSignal {
  static constexpr std::uint8_t kNoFaultBit = 0xFF;

  std::string_view name;
  CanRole role = CanRole::other;
  std::uint8_t start_bit = 0;
  std::uint8_t bits = 0;  // 1 .. 32
  CanByteOrder order = CanByteOrder::motorola;
  bool is_signed = false;
  double scale = 1;  // SI value = raw * scale + offset
  double offset = 0;
  std::uint8_t fault_bit = kNoFaultBit;  // when this bit is set, the value has no meaning

  [[nodiscard]] constexpr std::int64_t raw(const CanData& data) const {
    std::uint64_t unsigned_raw = 0;
    for (unsigned i = 0; i < bits; ++i) unsigned_raw |= std::uint64_t{bit(data, position(i))} << i;
    const bool negative = is_signed && (unsigned_raw >> (bits - 1U) & 1U) != 0;
    return static_cast<std::int64_t>(unsigned_raw) - (negative ? std::int64_t{1} << bits : 0);
  }
  constexpr void set_raw(CanData& data, std::int64_t value) const {
    for (unsigned i = 0; i < bits; ++i) set_bit(data, position(i), (static_cast<std::uint64_t>(value) >> i & 1U) != 0);
  }

  [[nodiscard]] constexpr std::int64_t raw_min() const { return is_signed ? -(std::int64_t{1} << (bits - 1)) : 0; }
  [[nodiscard]] constexpr std::int64_t raw_max() const {
    return (std::int64_t{1} << (is_signed ? bits - 1 : bits)) - 1;
  }
  [[nodiscard]] constexpr double to_value(std::int64_t raw) const { return static_cast<double>(raw) * scale + offset; }
  [[nodiscard]] double value(const CanData& data) const { return to_value(raw(data)); }
  // Rounds to the nearest step; a value beyond the format becomes the format's last.
  void set_value(CanData& data, double value) const {
    const double steps =
        std::clamp((value - offset) / scale, static_cast<double>(raw_min()), static_cast<double>(raw_max()));
    set_raw(data, std::llround(steps));
  }

  [[nodiscard]] constexpr bool faulty(const CanData& data) const {
    return fault_bit != kNoFaultBit && bit(data, fault_bit) != 0;
  }
  constexpr void set_faulty(CanData& data, bool faulty) const {
    if (fault_bit != kNoFaultBit) set_bit(data, fault_bit, faulty);
  }
  // Whether all bits lie within a frame of that many bytes.
  [[nodiscard]] constexpr bool fits(unsigned length) const {
    const unsigned first = order == CanByteOrder::intel ? start_bit : start_bit ^ 7U;
    return first + bits <= 8U * length;
  }
  // Bytes that a frame must have. Precondition: the signal fits into eight.
  [[nodiscard]] constexpr unsigned bytes() const {
    const unsigned first = position(0) / 8U, last = position(bits - 1U) / 8U;
    return 1U + std::max(first, last);
  }

 private:
  // Of the i-th bit, from the least significant.
  [[nodiscard]] constexpr unsigned position(unsigned i) const {
    if (order == CanByteOrder::intel) return start_bit + i;
    // Written out from the most significant bit on, Motorola bits are consecutive when bits in a byte count from 7
    // down.
    const unsigned written = (start_bit ^ 7U) + (bits - 1U - i);
    return written ^ 7U;
  }
  static constexpr unsigned bit(const CanData& data, unsigned position) {
    return data[position / 8U] >> (position % 8U) & 1U;
  }
  static constexpr void set_bit(CanData& data, unsigned position, bool on) {
    const unsigned mask = 1U << (position % 8U);
    data[position / 8U] = static_cast<std::uint8_t>(on ? data[position / 8U] | mask : data[position / 8U] & ~mask);
  }
};

}  // namespace lxd
