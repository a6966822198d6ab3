// SPDX-License-Identifier: Apache-2.0
// The IMU inside the primary LiDAR, out of the LiDAR's own capture: its packets share the sensor's clock with the
// packets of points, and come onto the rig's clock as the sweeps do.
#pragma once

#include <filesystem>
#include <memory>

#include "drivers/replay/imu_source.hpp"

namespace lxd {

// recording: a rig recording's folder, or a lone capture. Errors: as the LiDAR's source has them.
// pulsed: the LiDAR's clock goes by the pulses of a rig recording's pps.csv.
Result<std::unique_ptr<ImuSource>> open_lidar_imu(const std::filesystem::path& recording, bool pulsed = false);

}  // namespace lxd
