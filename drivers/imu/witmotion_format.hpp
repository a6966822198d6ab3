// SPDX-License-Identifier: Apache-2.0
// WitMotion's frames (JY901, WT901, ...): 0x55, an id, eight bytes, the low byte of the sum of the ten before. Little
// endian. Source: witmotion_IMU_QT, doc/protocol.md, types.h, util.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>

#include "drivers/imu/standard_gravity.hpp"
#include "drivers/ouster/bit_field.hpp"

namespace lxd {

inline constexpr std::uint8_t kWitMotionSync = 0x55;
inline constexpr std::size_t kWitMotionFrameBytes = 11;
inline constexpr std::size_t kWitMotionChecksumAt = 10;

// The ids that are used here; all lie between the first and the last.
inline constexpr std::uint8_t kWitMotionTime = 0x50, kWitMotionAcceleration = 0x51, kWitMotionRate = 0x52;
inline constexpr std::uint8_t kWitMotionFirstId = 0x50, kWitMotionLastId = 0x5F;

// Full scale of int16 with the factory's settings. The vendor's documents call the rate's unit rad/s; the formula there
// and the sensor's range are in degrees a second.
inline constexpr double kWitMotionAccelUnit_mps2 = 16 * kStandardGravity_mps2 / 32768;
inline constexpr double kWitMotionRateUnit_radps = 2000 * std::numbers::pi / 180 / 32768;

namespace witmotion {
// From the frame's first byte.
inline constexpr std::array<BitField, 3> kAxes{bytes_at(2, 2), bytes_at(4, 2), bytes_at(6, 2)};
inline constexpr BitField kTemperature = bytes_at(8, 2);  // 0.01 degC, in frames of acceleration
inline constexpr BitField kYear = bytes_at(2, 1), kMonth = bytes_at(3, 1), kDay = bytes_at(4, 1);  // year since 2000
inline constexpr BitField kHour = bytes_at(5, 1), kMinute = bytes_at(6, 1), kSecond = bytes_at(7, 1);
inline constexpr BitField kMillisecond = bytes_at(8, 2);
inline constexpr int kFirstYear = 2000;
}  // namespace witmotion

// Precondition: ten bytes or more.
constexpr std::uint8_t witmotion_checksum(std::span<const std::uint8_t> frame) {
  unsigned sum = 0;
  for (std::size_t i = 0; i < kWitMotionChecksumAt; ++i) sum += frame[i];
  return static_cast<std::uint8_t>(sum);
}

}  // namespace lxd
