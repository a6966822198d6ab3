// SPDX-License-Identifier: Apache-2.0
// Nearest layer of one sub-mesh to a point: its own cell first, then the three neighbours on whose side it lies.
#pragma once

#include <cmath>

#include "mapping/sub_mesh.hpp"

namespace lxd {

struct SurfaceHit;

struct CellQuery {
  CellIndex index;           // the cell that the point is in
  Eigen::Vector3f p_cell_m;  // from that cell's lower corner
  float cell_size_m;
  float inverse_spacing;
  Eigen::Vector3f beam;  // unit, towards the point; zero: any side of a layer will do
};

bool nearest_layer(const SubMesh& sub_mesh, const CellQuery& query, SurfaceHit& hit) noexcept;

}  // namespace lxd
