// SPDX-License-Identifier: Apache-2.0
// What a simulated recording's folder may hold, and what it is known by.
#pragma once

#include <array>
#include <string_view>

#include "tools/recording/recording_folder.hpp"

namespace lxd::sim {

// In every simulated recording, and in nothing else: what it is and what was done to it.
inline constexpr const char* kSimulationFile = "simulation.json";

inline constexpr std::array<std::string_view, 19> kSimulationEntries{
    "lidar0",   "lidar0.pcap",   "lidar0.json", "lidar1",     "lidar1.pcap", "lidar1.json", "imu.serial",
    "imu.csv",  "imu_truth.csv", "can.log",     "wheel.csv",  "gnss.nmea",   "camera0",     "pps.csv",
    "gpio.csv", "truth.tum",     "world.ply",   "clocks.csv", "rig.yaml"};

inline constexpr RecordingKind kSimulatedRecording{"a simulated recording", kSimulationFile, kSimulationEntries};

}  // namespace lxd::sim
