// SPDX-License-Identifier: Apache-2.0
// One door for every kind of recording: it is recognised by what is there, not by its name.
#pragma once

#include <filesystem>
#include <memory>

#include "drivers/replay/options.hpp"
#include "drivers/replay/source.hpp"
#include "rt/result.hpp"

namespace lxd {

// A KITTI raw drive, a KITTI odometry sequence, a generic folder, or an Ouster .pcap with its metadata beside it.
// Errors name what was found and what each kind would have needed.
Result<std::unique_ptr<SweepSource>> open_recording(const std::filesystem::path& path, const ReplayOptions& options);

// The extra LiDAR of a rig recording or of a generic folder, on the same clock; pulsed: its own goes by the pulses of
// pps.csv. Error: there is none.
Result<std::unique_ptr<SweepSource>> open_extra_lidar(const std::filesystem::path& folder, bool pulsed = false);

}  // namespace lxd
