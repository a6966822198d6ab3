// SPDX-License-Identifier: Apache-2.0
// A rig recording: what `record` and `simulate` write. Its LiDAR is lidar0.pcap, of an Ouster when lidar0.json lies
// beside it, else of a Livox. Rig time is the recording host's clock.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "drivers/replay/source.hpp"
#include "drivers/replay/sweep_clock.hpp"

namespace lxd {

bool is_rig_recording(const std::filesystem::path& folder);

// Errors: the capture or its metadata cannot be read; neither an Ouster's metadata nor a Livox's packets.
// pulsed: its clock goes by the pulses of pps.csv.
Result<std::unique_ptr<SweepSource>> open_rig_recording(const std::filesystem::path& folder, bool pulsed = false);

// One of its LiDARs, "lidar0" or "lidar1", by another clock than the one that learns from arrival times.
Result<std::unique_ptr<SweepSource>> open_rig_lidar(const std::filesystem::path& folder, const std::string& lidar,
                                                    std::unique_ptr<SweepClock> clock);

}  // namespace lxd
