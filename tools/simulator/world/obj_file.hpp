// SPDX-License-Identifier: Apache-2.0
// Wavefront OBJ (Wavefront Technologies, "Object Files", 1995, appendix B1): vertices and faces, nothing else of it.
#pragma once

#include <filesystem>

#include "rt/result.hpp"
#include "tools/evaluate/triangle_mesh.hpp"

namespace lxd::sim {

// Faces may name vertices as v, v/vt, v//vn or v/vt/vn, from 1, or backwards from -1; polygons are cut into fans. All
// other statements (normals, groups, materials, curves) are passed over. Error: file, line, found, wanted.
Result<TriangleMesh> load_mesh_obj(const std::filesystem::path& path);

}  // namespace lxd::sim
