// SPDX-License-Identifier: Apache-2.0
// VectorNav's ASCII output: `$VNxxx,` numbers `*` check CR LF. The check is the XOR of all between `$` and `*` in two
// upper-case hex digits, or its CRC-16 in four. Sources: vnproglib 1.2, packet.cpp; VN-100 user manual, async outputs.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace lxd {

inline constexpr std::size_t kVectorNavLineMax = 256;  // with `$` and line end; a longer one is damaged
inline constexpr std::size_t kVectorNavNumbersMax = 16;
inline constexpr std::string_view kVectorNavError = "VNERR";

// A sentence with rate and acceleration: how many numbers it has, and which are the first of each.
struct VectorNavSentence {
  std::string_view address;
  std::size_t numbers, accel, gyro;
};

// VNIMU is uncompensated; of the others the biases that the sensor estimates are taken off.
inline constexpr std::array<VectorNavSentence, 4> kVectorNavSentences{{
    {"VNIMU", 11, 3, 6},   // magnetic field, acceleration, rate, temperature, pressure
    {"VNMAR", 9, 3, 6},    // magnetic field, acceleration, rate
    {"VNYMR", 12, 6, 9},   // yaw, pitch, roll, magnetic field, acceleration, rate
    {"VNQMR", 13, 7, 10},  // quaternion, magnetic field, acceleration, rate
}};

constexpr std::uint8_t vectornav_ascii_checksum(std::string_view body) {
  unsigned sum = 0;
  for (const char c : body) sum ^= static_cast<std::uint8_t>(c);
  return static_cast<std::uint8_t>(sum);
}

}  // namespace lxd
