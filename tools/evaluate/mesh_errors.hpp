// SPDX-License-Identifier: Apache-2.0
// How well a mesh covers the world it was made of.
#pragma once

#include <span>

#include <Eigen/Core>

#include "tools/evaluate/report.hpp"
#include "tools/evaluate/triangle_mesh.hpp"

namespace lxd {

struct MeshErrorOptions {
  std::size_t samples = 100'000;  // of either surface, spread evenly over its area
  double reach_m = 1.0;           // distances are cut off here
  double view_range_m = 30.0;     // world further than this from every viewpoint does not count
  double viewpoint_spacing_m = 1.0;
};

// Accuracy: distance of the mesh's samples to the world. Completeness: distance of the world's samples to the mesh, of
// those samples that could be seen from the truth's path: within view_range_m and a free line of sight from at least
// one viewpoint. The sensor's vertical field of view is not considered. Precision, recall and F-score count what lies
// within 2, 5 and 10 cm. Both meshes in truth's world.
MeshErrors mesh_errors(const TriangleMesh& mesh, const TriangleMesh& world, std::span<const Eigen::Vector3d> path_m,
                       const MeshErrorOptions& options);

}  // namespace lxd
