// SPDX-License-Identifier: Apache-2.0
// `overview.png`: the map and the path at one glance, from above and obliquely. Made of the archive, sub-mesh by
// sub-mesh.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>

#include "backend/archive.hpp"
#include "backend/trajectory.hpp"
#include "rt/result.hpp"

namespace lxd {

struct OverviewInfo {
  std::string title;         // e.g. the recording's name
  std::uint64_t sweeps = 0;  // 0: not told
};

// 1800 x 900 pixels. Surfaces are shown from the side that the LiDAR saw only: ceilings and near walls do not hide the
// rooms behind them. Error: a damaged archive, or the picture cannot be written.
Status write_overview(const std::filesystem::path& png, const Archive& archive, std::span<const StampedPose> path,
                      const OverviewInfo& info);

}  // namespace lxd
