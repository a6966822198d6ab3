// SPDX-License-Identifier: Apache-2.0
// The vehicles that are known. Sources: AgileX: ugv_sdk `agilex_protocol_v2.h` and the Scout manual; Toyota, Honda,
// Nissan: opendbc `_toyota_2017.dbc`, `_honda_common.dbc`, `nissan_leaf_2018.dbc`.
#include <numbers>

#include "drivers/wheel/can_table.hpp"

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

// Four words of 15 bits without gaps; the last half byte is the checksum.
constexpr CanSignal honda_wheel(std::string_view name, CanRole role, std::uint8_t start_bit) {
  constexpr double kStep_kmh = 0.01;
  return {name,
          role,
          start_bit,
          15,
          CanByteOrder::motorola,
          false,
          kStep_kmh * kKilometrePerHour_mps,
          0,
          CanSignal::kNoFaultBit};
}
constexpr std::array kHondaWheels{
    honda_wheel("WHEEL_SPEED_FL", CanRole::front_left, 7),
    honda_wheel("WHEEL_SPEED_FR", CanRole::front_right, 8),
    honda_wheel("WHEEL_SPEED_RL", CanRole::rear_left, 25),
    honda_wheel("WHEEL_SPEED_RR", CanRole::rear_right, 42),
};
constexpr std::array kHonda{CanMessage{0x1D0, "WHEEL_SPEEDS", 8, CanChecksum::honda, kHondaWheels}};

constexpr CanSignal nissan_wheel(std::string_view name, CanRole role, int byte) {
  constexpr double kStep_kmh = 0.005;
  return {name,
          role,
          word_at(byte),
          16,
          CanByteOrder::motorola,
          false,
          kStep_kmh * kKilometrePerHour_mps,
          0,
          CanSignal::kNoFaultBit};
}
constexpr std::array kNissanFront{
    nissan_wheel("WHEEL_SPEED_FR", CanRole::front_right, 0),
    nissan_wheel("WHEEL_SPEED_FL", CanRole::front_left, 2),
};
constexpr std::array kNissanRear{
    nissan_wheel("WHEEL_SPEED_RR", CanRole::rear_right, 0),
    nissan_wheel("WHEEL_SPEED_RL", CanRole::rear_left, 2),
};
constexpr std::array kNissan{
    CanMessage{0x284, "WHEEL_SPEEDS_FRONT", 8, CanChecksum::none, kNissanFront},
    CanMessage{0x285, "WHEEL_SPEEDS_REAR", 8, CanChecksum::none, kNissanRear},
};

}  // namespace

std::span<const CanMessage> agilex_messages() { return kAgilex; }
std::span<const CanMessage> toyota_messages() { return kToyota; }
std::span<const CanMessage> honda_messages() { return kHonda; }
std::span<const CanMessage> nissan_messages() { return kNissan; }

}  // namespace lxd
