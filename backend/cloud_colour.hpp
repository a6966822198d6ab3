// SPDX-License-Identifier: Apache-2.0
// The colours of a finished cloud: each point has that of the surface around it, in the sub-mesh that was built at its
// time. One sub-mesh at a time is in memory.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "backend/archive.hpp"
#include "rt/pose.hpp"
#include "rt/result.hpp"
#include "rt/time.hpp"

namespace lxd {

// A sub-mesh of the archive, where the cloud has it.
struct PlacedSubmesh {
  RigTime begin;
  std::int64_t id = 0;
  Pose T_cloud_submesh;
};

// submeshes: in order of time. radius_m: the spacing of their vertices. Rewrites the cloud; error: reading, writing,
// the cloud is then as it was.
Status colour_cloud(const std::filesystem::path& cloud_ply, const Archive& archive,
                    std::span<const PlacedSubmesh> submeshes, double radius_m);

}  // namespace lxd
