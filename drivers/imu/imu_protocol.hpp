// SPDX-License-Identifier: Apache-2.0
// The serial protocols of IMUs, by the names that rig files and scenarios use.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace lxd {

enum class ImuProtocol { kVectorNav, kVectorNavAscii, kWitMotion, kMicroStrain, kXsens };

inline constexpr std::array<std::string_view, 5> kImuProtocolNames{"vectornav", "vectornav-ascii", "witmotion",
                                                                   "microstrain", "xsens"};

constexpr std::string_view name_of(ImuProtocol protocol) {
  return kImuProtocolNames[static_cast<std::size_t>(protocol)];
}

constexpr std::optional<ImuProtocol> find_imu_protocol(std::string_view name) {
  for (std::size_t i = 0; i < kImuProtocolNames.size(); ++i) {
    if (kImuProtocolNames[i] == name) return static_cast<ImuProtocol>(i);
  }
  return std::nullopt;
}

}  // namespace lxd
