// SPDX-License-Identifier: Apache-2.0
#include "board/map_losses.hpp"

namespace lxd {

void count_losses(const SubMesh& sub_mesh, const MeshCounters& mesh, Report& report) {
  const auto count = [&report](const char* cause, std::uint64_t times) {
    if (times > 0) report.dropped[cause] += times;
  };
  count("points_without_cell", sub_mesh.counters().cells_full);
  count("surfaces_without_layer", sub_mesh.counters().layers_full);
  count("points_without_waiting_place", sub_mesh.counters().waiting_full);
  count("mesh_layers", mesh.layers_lost);
  count("mesh_corners", mesh.corners_lost);
  count("mesh_vertices", mesh.vertices_lost);
  count("mesh_faces", mesh.faces_lost);
  count("mesh_trims", mesh.trims_lost);
  count("mesh_seam_edges", mesh.seam_lost);
}

}  // namespace lxd
