// SPDX-License-Identifier: Apache-2.0
// A sample in the bytes of any of the protocols.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "drivers/imu/imu_protocol.hpp"
#include "tools/simulator/imu/imu_errors.hpp"

namespace lxd::sim {

std::size_t bytes_per_sample(ImuProtocol protocol);

// Which times of the sensor's clock the protocol can say, and in words.
bool can_be_sent(ImuProtocol protocol, std::int64_t sensor_ns);
std::string_view times_that_can_be_sent(ImuProtocol protocol);

// The sample's number is for protocols that count. Precondition: can_be_sent.
std::vector<std::uint8_t> encode_sample(ImuProtocol protocol, std::uint64_t number, std::int64_t sensor_ns,
                                        const Inertial& sample);

}  // namespace lxd::sim
