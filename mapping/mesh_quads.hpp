// SPDX-License-Identifier: Apache-2.0
// Which quads of a layer become faces: those that were seen, and small holes between seen ones.
#pragma once

#include <cstdint>

#include "mapping/sub_mesh.hpp"

namespace lxd {

// Bits as in Layer::seen_quads. Neighbours are looked for across the cell's borders too.
std::uint32_t exported_quads(const SubMesh& sub_mesh, std::uint32_t layer, float cell_size_m);

}  // namespace lxd
