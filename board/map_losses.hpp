// SPDX-License-Identifier: Apache-2.0
// What the bounded map, or its mesh, had no room for: lost by design, and told by cause in the report's `dropped`.
#pragma once

#include "board/report.hpp"
#include "mapping/mesh_extraction.hpp"
#include "mapping/sub_mesh.hpp"

namespace lxd {

// Of a sub-mesh whose mesh has just been extracted; once for each.
void count_losses(const SubMesh& sub_mesh, const MeshCounters& mesh, Report& report);

}  // namespace lxd
