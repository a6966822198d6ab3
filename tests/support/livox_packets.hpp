// SPDX-License-Identifier: Apache-2.0
// Livox SDK2 datagrams for tests, made by hand (Python's struct and zlib) from the maker's tables, not by our encoder.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace lxd::test {

// All: timestamp 1767268800123456789, packet 7 of frame 3.
// Two points, 1.5 -2.5 0.3 m (reflectivity 75, tag 0) and -70 0.001 -0.002 m (150, 0x20); PTP; 480 us.
inline constexpr std::string_view kLivoxCartesian =
    "004000c0120200070003010100000000000000000000000029731d02154dfd3d9c998618dc0500003cf6ffff2c010000"
    "4b0090eefeff01000000feffffff9620";
// As above in centimetres: 1.5 -2.5 0.3 and -70 0.01 -0.02 m (tag 0x02); own clock; no check value.
inline constexpr std::string_view kLivoxLow =
    "003400c0120200070003020000000000000000000000000000000000154dfd3d9c998618960006ff1e004b00a8e40100"
    "feff9602";
// One point at 2 m, zenith 90 deg, azimuth 270 deg (reflectivity 10, tag 0x10); GPS.
inline constexpr std::string_view kLivoxSpherical =
    "002e00c01201000700030302000000000000000000000000086ffac7154dfd3d9c998618d0070000282378690a10";
// The first Cartesian point, with a second echo.
inline constexpr std::string_view kLivoxDual =
    "004000c0120100070003110100000000000000000000000066287cd6154dfd3d9c998618dc0500003cf6ffff2c010000"
    "4b000900000009000000090000000900";
// Gyro 0.125 -0.25 0.5 rad/s, accelerometer 0 -0.5 1 g; PTP.
inline constexpr std::string_view kLivoxImu =
    "003c00000001000700030001000000000000000000000000f55219ad154dfd3d9c9986180000003e000080be0000003f"
    "00000000000000bf0000803f";

inline std::vector<std::uint8_t> from_hex(std::string_view hex) {
  const auto digit = [](char c) { return static_cast<unsigned>(c <= '9' ? c - '0' : c - 'a' + 10); };
  std::vector<std::uint8_t> bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes.push_back(static_cast<std::uint8_t>(digit(hex[i]) << 4U | digit(hex[i + 1])));
  }
  return bytes;
}

}  // namespace lxd::test
