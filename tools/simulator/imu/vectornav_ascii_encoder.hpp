// SPDX-License-Identifier: Apache-2.0
// Lines as a VectorNav sends them.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "drivers/imu/vectornav_ascii_format.hpp"
#include "tools/simulator/imu/imu_errors.hpp"

namespace lxd::sim {

// Of VNIMU lines, whose numbers have as many digits as the format says, whatever their value.
inline constexpr std::size_t kVectorNavLineBytes = 113;
inline constexpr double kVectorNavLineAccelUnit_mps2 = 1e-3, kVectorNavLineRateUnit_radps = 1e-6;

// `$` body `*` XOR of the body, CR LF.
std::vector<std::uint8_t> vectornav_line(std::string_view body);

// A VNIMU line. Values beyond its digits become the last ones; what is no number becomes the lowest.
std::vector<std::uint8_t> encode_vectornav_line(const Inertial& sample);

}  // namespace lxd::sim
