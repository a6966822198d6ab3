// SPDX-License-Identifier: Apache-2.0
// Packets as a MicroStrain sends them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "drivers/imu/mip_format.hpp"
#include "tools/simulator/imu/imu_errors.hpp"

namespace lxd::sim {

// Scaled acceleration, scaled rate, reference time.
inline constexpr std::size_t kMipSampleBytes = kMipHeaderBytes + 3 * kMipFieldHeaderBytes +
                                               mip::kScaledAccel.data_bytes + mip::kScaledGyro.data_bytes +
                                               mip::kReferenceTime.data_bytes + kMipChecksumBytes;

// A packet of a set with the fields in `payload`. Precondition: at most 255 bytes.
std::vector<std::uint8_t> encode_mip_packet(std::uint8_t set, std::span<const std::uint8_t> payload);

// The fields of a packet, one behind the other.
std::vector<std::uint8_t> mip_inertial_fields(const Inertial& sample);
std::vector<std::uint8_t> mip_reference_time(std::int64_t sensor_ns);

// Precondition: sensor_ns >= 0.
std::vector<std::uint8_t> encode_mip(std::int64_t sensor_ns, const Inertial& sample);

}  // namespace lxd::sim
