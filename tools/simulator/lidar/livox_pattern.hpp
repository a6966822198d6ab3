// SPDX-License-Identifier: Apache-2.0
// Where a simulated Mid-360 looks: an approximation of its scan, which the maker does not publish. What is kept of it:
// 200,000 shots a second by four lines in turn, 360 degrees by -7 to 52, never the same path twice, and a picture that
// gets denser the longer one looks. Azimuth turns fast, each line's elevation runs up and down at an incommensurate
// rate, the lines a quarter of that apart.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>

#include <Eigen/Core>

namespace lxd::sim {

inline constexpr std::uint64_t kLivoxShot_ns = 5'000;
inline constexpr std::uint64_t kLivoxPacketPoints = 96;
inline constexpr std::uint64_t kLivoxPacket_ns = kLivoxShot_ns * kLivoxPacketPoints;
inline constexpr std::uint64_t kLivoxFrame_ns = 100'000'000;
inline constexpr std::uint64_t kLivoxLines = 4;
inline constexpr double kLivoxLow_rad = -7 * std::numbers::pi / 180, kLivoxHigh_rad = 52 * std::numbers::pi / 180;
inline constexpr double kLivoxTurns_hz = 53.7;
inline constexpr double kLivoxSweeps_hz = 7.3 * std::numbers::phi;  // up and down again

// Packets and frames are counted from the recording's start. A frame holds the packets that begin in it: 208 or 209.
constexpr std::uint64_t livox_first_packet(std::uint64_t frame) {
  return (frame * kLivoxFrame_ns + kLivoxPacket_ns - 1) / kLivoxPacket_ns;
}
constexpr double livox_shot_s(std::uint64_t packet, std::uint64_t shot) {
  return static_cast<double>(packet * kLivoxPacket_ns + shot * kLivoxShot_ns) * 1e-9;
}

// Unit vector in the sensor's frame of the shot at t_s by a line.
inline Eigen::Vector3d livox_direction(double t_s, std::uint64_t line) {
  const double azimuth = 2 * std::numbers::pi * kLivoxTurns_hz * t_s;
  const double cycles = kLivoxSweeps_hz * t_s + static_cast<double>(line) / static_cast<double>(kLivoxLines);
  const double up_and_down = std::abs(2 * (cycles - std::floor(cycles)) - 1);  // 1 .. 0 .. 1, evenly
  const double elevation = kLivoxLow_rad + (kLivoxHigh_rad - kLivoxLow_rad) * up_and_down;
  return {std::cos(elevation) * std::cos(azimuth), std::cos(elevation) * std::sin(azimuth), std::sin(elevation)};
}

}  // namespace lxd::sim
