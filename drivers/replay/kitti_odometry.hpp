// SPDX-License-Identifier: Apache-2.0
// KITTI odometry sequences: 00/{velodyne/*.bin,times.txt}, of scans that are deskewed already.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "drivers/replay/options.hpp"
#include "drivers/replay/source.hpp"

namespace lxd {

// The sequence folders that `folder` may stand for: itself, or those below its sequences/.
std::vector<std::filesystem::path> find_kitti_odometry(const std::filesystem::path& folder);

// Rig time zero is that of times.txt. Begin, stamp and end of a sweep are one time. Errors: no scans, no times.
Result<std::unique_ptr<SweepSource>> open_kitti_odometry(const std::filesystem::path& sequence,
                                                         const ReplayOptions& options);

}  // namespace lxd
