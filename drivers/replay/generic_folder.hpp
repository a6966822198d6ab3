// SPDX-License-Identifier: Apache-2.0
// The generic folder for data that has no packets: lidar0/000000.bin (float32 x y z intensity t_offset_s) with
// lidar0/times.txt (seconds, a line a scan: the stamp of its first point). Other sensors' files are not read.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "drivers/replay/source.hpp"

namespace lxd {

bool is_generic_folder(const std::filesystem::path& folder);

// Rig time zero is that of times.txt. A sweep's stamp is its end, the time of its last point. Errors: no scans, no
// times.
Result<std::unique_ptr<SweepSource>> open_generic_folder(const std::filesystem::path& folder,
                                                         const std::string& lidar = "lidar0");

}  // namespace lxd
