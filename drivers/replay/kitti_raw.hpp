// SPDX-License-Identifier: Apache-2.0
// KITTI raw drives: 2011_09_26_drive_0005_sync/velodyne_points/{data/*.bin,timestamps*.txt}.
#pragma once

#include <filesystem>
#include <memory>
#include <vector>

#include "drivers/replay/options.hpp"
#include "drivers/replay/source.hpp"

namespace lxd {

// The velodyne_points folders that `folder` may stand for: itself, the one of a drive, those of the drives of a date.
std::vector<std::filesystem::path> find_kitti_raw(const std::filesystem::path& folder);

// Rig time zero is the first line of timestamps.txt. Errors: no scans, no or unreadable times.
Result<std::unique_ptr<SweepSource>> open_kitti_raw(const std::filesystem::path& velodyne_points,
                                                    const ReplayOptions& options);

}  // namespace lxd
