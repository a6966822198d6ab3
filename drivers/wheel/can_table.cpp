// SPDX-License-Identifier: Apache-2.0
// Sources: AgileX: ugv_sdk `agilex_protocol_v2.h` and the Scout manual; Toyota: opendbc `_toyota_2017.dbc`,
// `toyotacan.py`.
#include "drivers/wheel/can_table.hpp"

#include <numbers>

namespace lxd {
namespace {

constexpr double kKilometrePerHour_mps = 1 / 3.6;
constexpr double kDegree_rad = std::numbers::pi / 180;
constexpr double kMilli = 1e-3;

// The first bit of a Motorola word that begins at a byte.
constexpr std::uint8_t word_at(int byte) { return static_cast<std::uint8_t>(8 * byte + 7); }

constexpr CanSignal signed_word(std::string_view name, CanRole role, int byte, std::uint8_t bits, double scale) {
  return {name, role, word_at(byte), bits, CanByteOrder::motorola, true, scale, 0, CanSignal::kNoFaultBit};
}

constexpr std::array kAgilexMotion{
    signed_word("linear_velocity", CanRole::speed, 0, 16, kMilli),
    signed_word("angular_velocity", CanRole::yaw_rate, 2, 16, kMilli),
    signed_word("lateral_velocity", CanRole::other, 4, 16, kMilli),
    signed_word("steering_angle", CanRole::other, 6, 16, kMilli),
};
constexpr std::array kAgilexOdometry{
    signed_word("left_wheel", CanRole::odometer_left, 0, 32, kMilli),
    signed_word("right_wheel", CanRole::odometer_right, 4, 32, kMilli),
};
constexpr std::array kAgilex{
    CanMessage{0x221, "motion_state", 8, CanChecksum::none, kAgilexMotion},
    CanMessage{0x311, "odometry", 8, CanChecksum::none, kAgilexOdometry},
};

// Low 15 bits of a word are the speed, its bit 15 says that the value is none.
constexpr CanSignal toyota_wheel(std::string_view name, CanRole role, int byte) {
  constexpr double kStep_kmh = 0.01, kZero_kmh = -67.67;
  return {name,
          role,
          static_cast<std::uint8_t>(word_at(byte) - 1),
          15,
          CanByteOrder::motorola,
          false,
          kStep_kmh * kKilometrePerHour_mps,
          kZero_kmh * kKilometrePerHour_mps,
          word_at(byte)};
}

constexpr std::array kToyotaWheels{
    toyota_wheel("WHEEL_SPEED_FR", CanRole::front_right, 0),
    toyota_wheel("WHEEL_SPEED_FL", CanRole::front_left, 2),
    toyota_wheel("WHEEL_SPEED_RR", CanRole::rear_right, 4),
    toyota_wheel("WHEEL_SPEED_RL", CanRole::rear_left, 6),
};
constexpr std::array kToyotaSpeed{
    CanSignal{"ENCODER", CanRole::other, word_at(4), 8, CanByteOrder::motorola, false, 1, 0, CanSignal::kNoFaultBit},
    CanSignal{"SPEED", CanRole::speed, word_at(5), 16, CanByteOrder::motorola, false, 0.01 * kKilometrePerHour_mps, 0,
              CanSignal::kNoFaultBit},
};
constexpr std::array kToyotaKinematics{
    CanSignal{"YAW_RATE", CanRole::yaw_rate, 1, 10, CanByteOrder::motorola, false, 0.244 * kDegree_rad,
              -125 * kDegree_rad, CanSignal::kNoFaultBit},
};
constexpr std::array kToyota{
    CanMessage{0x0AA, "WHEEL_SPEEDS", 8, CanChecksum::none, kToyotaWheels},
    CanMessage{0x0B4, "SPEED", 8, CanChecksum::toyota, kToyotaSpeed},
    CanMessage{0x024, "KINEMATICS", 8, CanChecksum::toyota, kToyotaKinematics},
};

std::uint8_t toyota_checksum(const CanMessage& message, const CanData& data) {
  unsigned sum = message.length + (message.id >> 8U) + (message.id & 0xFFU);
  for (std::size_t i = 0; i + 1 < message.length; ++i) sum += data[i];
  return static_cast<std::uint8_t>(sum & 0xFFU);
}

}  // namespace

std::span<const CanMessage> agilex_messages() { return kAgilex; }
std::span<const CanMessage> toyota_messages() { return kToyota; }

const CanMessage* find_message(std::span<const CanMessage> table, std::uint32_t id) {
  for (const CanMessage& message : table)
    if (message.id == id) return &message;
  return nullptr;
}

const CanSignal* find_signal(const CanMessage& message, std::string_view name) {
  for (const CanSignal& signal : message.signals)
    if (signal.name == name) return &signal;
  return nullptr;
}

bool checksum_holds(const CanMessage& message, const CanData& data) {
  return message.checksum == CanChecksum::none || data[message.length - 1U] == toyota_checksum(message, data);
}

void set_checksum(const CanMessage& message, CanData& data) {
  if (message.checksum == CanChecksum::toyota) data[message.length - 1U] = toyota_checksum(message, data);
}

CanValues decode_signals(const CanMessage& message, const CanData& data) {
  CanValues values;
  for (const CanSignal& signal : message.signals) {
    if (signal.faulty(data)) {
      values.fault = true;
    } else {
      values.by_role[static_cast<std::size_t>(signal.role)] = {&signal, signal.raw(data)};
    }
  }
  return values;
}

}  // namespace lxd
