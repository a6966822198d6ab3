// SPDX-License-Identifier: Apache-2.0
// Mesh files that other programs open, streamed out of the archive: memory is that of one sub-mesh, however large the
// map. Where several sub-meshes show one surface there is one layer (README, "Seams"); beside the file is room for
// 60 bytes a vertex while it is written.
#pragma once

#include <filesystem>

#include "backend/archive.hpp"
#include "rt/result.hpp"

namespace lxd {

// Binary little-endian PLY in the map frame. Vertex: float x y z (m), nx ny nz, variance (m^2, along the normal), and
// where any colour is known uchar red green blue views (images that saw it; 0: a neutral grey); face: uchar-counted int
// list `vertex_indices`. Error: writing, a damaged archive, more than 2^31 vertices.
Status write_mesh_ply(const std::filesystem::path& path, const Archive& archive);

// glTF 2.0 binary. One node a sub-mesh, whose matrix is T_map_submesh, below one that turns z-up into glTF's y-up; the
// variance is the vertex attribute _VARIANCE; where any colour is known COLOR_0 has it, linear as glTF wants it, its
// alpha 0 where no camera saw (the material is opaque: viewers do not look at it). Error: writing, a damaged archive,
// more than glTF's 4 GiB.
Status write_mesh_glb(const std::filesystem::path& path, const Archive& archive);

}  // namespace lxd
