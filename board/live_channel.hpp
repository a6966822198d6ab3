// SPDX-License-Identifier: Apache-2.0
// The sensors of a live rig and its time signals, whose bytes come over wires, as their chunks are numbered.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace lxd {

enum class LiveChannel : std::uint8_t { lidar0, lidar1, imu, wheel, gnss, camera0, pps, triggers, kCount };

inline constexpr std::size_t kLiveChannels = static_cast<std::size_t>(LiveChannel::kCount);
inline constexpr std::array<std::string_view, kLiveChannels> kLiveChannelNames{"lidar0", "lidar1",  "imu", "wheel",
                                                                               "gnss",   "camera0", "pps", "triggers"};

constexpr std::size_t index_of(LiveChannel channel) { return static_cast<std::size_t>(channel); }
constexpr std::uint8_t number_of(LiveChannel channel) { return static_cast<std::uint8_t>(channel); }
constexpr std::string_view name_of(LiveChannel channel) { return kLiveChannelNames[index_of(channel)]; }
constexpr LiveChannel channel_at(std::size_t index) { return static_cast<LiveChannel>(index); }

}  // namespace lxd
