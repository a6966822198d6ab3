// SPDX-License-Identifier: Apache-2.0
// Which way a layer looks: the lattice axis that it is a height over, and the side of it that the LiDAR was on.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "mapping/sub_mesh.hpp"

namespace lxd {

// The axis for a new layer in the cell at `index`, of a surface with this unit normal. A surface at about 45 degrees to
// two axes takes the one that its continuations in the cells around have, so that their meshes share border vertices.
[[nodiscard]] int axis_for(const SubMesh& sub_mesh, const CellIndex& index, const Eigen::Vector3f& normal,
                           float cell_size_m);

// +1 or -1: on which side of the layer's plane the LiDAR is; position in the cell's frame. A look under so flat an
// angle that the plane itself may have it wrong changes nothing.
[[nodiscard]] std::int8_t side_of(const Layer& layer, const Eigen::Vector3f& sensor_cell_m, float cell_size_m);

}  // namespace lxd
