// SPDX-License-Identifier: Apache-2.0
// Messages as an Xsens sends them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "drivers/imu/xsens_format.hpp"
#include "tools/simulator/imu/imu_errors.hpp"

namespace lxd::sim {

inline constexpr std::size_t kXsensSampleBytes = 47;
inline constexpr std::int64_t kXsensTimeEnd_ns = (std::int64_t{1} << 32) * xsens::kSampleTick_ns;

// A message with these data, with the extended length where they need it.
std::vector<std::uint8_t> encode_xsens_message(std::uint8_t message, std::span<const std::uint8_t> data);

// Packet counter, sample time, acceleration, rate. The device's time has 32 bits of 100 us, so it is cut to that, and
// the counter to 16.
std::vector<std::uint8_t> encode_xsens(std::uint64_t counter, std::int64_t sensor_ns, const Inertial& sample);

}  // namespace lxd::sim
