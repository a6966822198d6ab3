// SPDX-License-Identifier: Apache-2.0
// A finished cloud gets what its surfaces know: each point the normal, the variance and the colour of the surface
// around it, in the sub-mesh that was built at its time. One sub-mesh at a time is in memory.
#pragma once

#include <filesystem>
#include <span>

#include "backend/archive.hpp"
#include "backend/placed_surface.hpp"
#include "backend/trajectory.hpp"
#include "rt/result.hpp"

namespace lxd {

struct CloudSurfaces {
  std::span<const PlacedSubmesh> submeshes{};  // in order of time
  std::span<const StampedPose> path{};         // that the points were seen from, in the cloud's frame; empty: unknown
  std::span<const Eigen::Vector3d> sensors{};  // in the frame that the path is of
  double radius_m = 0;                         // the spacing of the vertices
  bool coloured = false;                       // whether any of the sub-meshes is
};

// Rewrites the cloud; error: reading, writing, the cloud is then as it was.
Status add_surfaces(const std::filesystem::path& cloud_ply, const Archive& archive, const CloudSurfaces& surfaces);

}  // namespace lxd
