// SPDX-License-Identifier: Apache-2.0
// The lengths that seams are fused by: all follow from the spacing of the mesh's vertices, but for how far two layers
// of one surface may lie apart.
#pragma once

#include <cmath>
#include <span>

#include "mapping/mesh.hpp"

namespace lxd {

// Two layers farther apart than this are two surfaces, whatever their variances say: a kerb is higher.
inline constexpr float kLayerGapMax_m = 0.10F;
// Standard deviation of what the poses of two sub-meshes leave between their layers: the simulated street's after its
// closures is 0.02 m.
inline constexpr float kPoseResidual_m = 0.02F;

struct SeamScale {
  float spacing_m;  // of vertices

  // Vertices this far away, along the surface, tell where a layer is.
  [[nodiscard]] float kernel_m() const { return 1.5F * spacing_m; }
  [[nodiscard]] float reach_m() const { return std::sqrt(kernel_m() * kernel_m() + kLayerGapMax_m * kLayerGapMax_m); }
  // A rim's vertices are moved along the surface by this at most to meet another's.
  [[nodiscard]] float snap_m() const { return 1.5F * spacing_m; }
  [[nodiscard]] float tile_m() const { return 80 * spacing_m; }
  // Around a tile, what its vertices' fate depends on.
  [[nodiscard]] float halo_m() const { return reach_m() + snap_m(); }
};

// The median length of the edges of a mesh, of some evenly taken out of all; 0: it has none.
float edge_length_m(std::span<const MeshVertex> vertices, std::span<const MeshFace> faces);

}  // namespace lxd
