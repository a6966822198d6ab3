// SPDX-License-Identifier: Apache-2.0
// A simulated Ouster into a recording's folder.
#pragma once

#include <filesystem>

#include "rt/result.hpp"
#include "tools/simulator/context.hpp"
#include "tools/simulator/lidar/lidar_log.hpp"
#include "tools/simulator/lidar/lidar_output.hpp"
#include "tools/simulator/lidar/ouster_config.hpp"

namespace lxd::sim {

// What can be known before the work: a duration shorter than a sweep, a stamp before the clock's zero.
Status check_ouster(const Context& context, const OusterConfig& config);

// As packets: <sensor>.pcap and <sensor>.json; as scans: <sensor>/, with the faults of shots (empty, zero, one_voxel,
// max_points) and the times when the sensor is off or restarts, but none of packets and clocks. Whole turns only.
// Errors: the duration is shorter than a turn, a stamp before the clock's zero, the folder, its disk.
Result<LidarLog> write_ouster(const Context& context, const OusterConfig& config, const std::filesystem::path& folder,
                              const LidarOutput& output = {});

}  // namespace lxd::sim
