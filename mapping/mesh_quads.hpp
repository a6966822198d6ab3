// SPDX-License-Identifier: Apache-2.0
// Which quads of a layer become faces: those that were seen, and small holes between seen ones.
#pragma once

#include <cstdint>

#include "mapping/sub_mesh.hpp"

namespace lxd {

// Is a quad that nobody saw a small hole? Neighbours are looked for across the cell's borders too.
bool is_small_hole(const SubMesh& sub_mesh, const Layer& layer, int quad, float cell_size_m);

// Is it one with a seen neighbour on two adjacent sides only, as along a border that runs across the lattice?
bool is_notch(const SubMesh& sub_mesh, const Layer& layer, int quad, float cell_size_m);

// Those that were seen and small holes; bits as in Layer::seen_quads.
std::uint32_t exported_quads(const SubMesh& sub_mesh, std::uint32_t layer, float cell_size_m);

}  // namespace lxd
