// SPDX-License-Identifier: Apache-2.0
// How well a mesh covers the world it was made of, and whether it knows how far it is off.
#pragma once

#include <numbers>
#include <span>
#include <vector>

#include "rt/pose.hpp"
#include "tools/evaluate/report.hpp"
#include "tools/evaluate/triangle_mesh.hpp"
#include "tools/evaluate/world_sight.hpp"

namespace lxd {

struct MeshErrorOptions {
  std::size_t samples = 100'000;  // of either surface, spread evenly over its area
  double reach_m = 1.0;           // distances are cut off here
  double view_range_m = 30.0;     // world further than this from every viewpoint does not count
  double viewpoint_spacing_m = 1.0;
  double viewpoint_turn_rad = 10 * std::numbers::pi / 180;
  std::vector<LidarView> lidars;  // none: one that sees everywhere, up to view_range_m
};

// Accuracy: distance of the mesh's samples to the world. Completeness: distance of the world's samples to the mesh, of
// those samples that a LiDAR could see on the true path (T_world_reference; WorldSight says what that means; glass
// returns nothing). Precision, recall and F-score count what lies within 2, 5 and 10 cm. Calibration: the mesh's
// samples' distances against their own variance. Both meshes in truth's world.
MeshErrors mesh_errors(const TriangleMesh& mesh, const TriangleMesh& world, std::span<const Pose> path,
                       const MeshErrorOptions& options);

}  // namespace lxd
