// SPDX-License-Identifier: Apache-2.0
// Numbers with their high byte first, as MicroStrain and Xsens send them; byte by byte, so no alignment is needed.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

#include <Eigen/Core>

namespace lxd {

// Precondition of all: `at` and as many bytes behind it as the number has.
constexpr std::uint64_t get_big_endian(const std::uint8_t* at, std::size_t bytes) {
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < bytes; ++i) value = value << 8U | at[i];
  return value;
}
constexpr void put_big_endian(std::uint8_t* at, std::size_t bytes, std::uint64_t value) {
  for (std::size_t i = bytes; i > 0; --i, value >>= 8U) at[i - 1] = static_cast<std::uint8_t>(value);
}

constexpr double get_big_endian_float(const std::uint8_t* at) {
  return std::bit_cast<float>(static_cast<std::uint32_t>(get_big_endian(at, sizeof(float))));
}
constexpr double get_big_endian_double(const std::uint8_t* at) {
  return std::bit_cast<double>(get_big_endian(at, sizeof(double)));
}

inline Eigen::Vector3d get_big_endian_floats(const std::uint8_t* at) {
  constexpr std::size_t kStep = sizeof(float);
  return {get_big_endian_float(at), get_big_endian_float(at + kStep), get_big_endian_float(at + 2 * kStep)};
}
inline void put_big_endian_floats(std::uint8_t* at, const Eigen::Vector3d& v) {
  for (int i = 0; i < 3; ++i)
    put_big_endian(at + sizeof(float) * static_cast<std::size_t>(i), sizeof(float),
                   std::bit_cast<std::uint32_t>(static_cast<float>(v[i])));
}

}  // namespace lxd
