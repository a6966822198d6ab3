// SPDX-License-Identifier: Apache-2.0
// How far the vertices of a mesh are from its rim, in edges: what is well within a mesh is better known than what is
// at its rim, and blends there.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mapping/mesh.hpp"

namespace lxd {

inline constexpr std::uint8_t kRingsMax = 8;  // farther within counts as this

// rings: one a vertex, 0: on the rim (or of no face).
void measure_rim_distance(std::size_t vertices, std::span<const MeshFace> faces, std::vector<std::uint8_t>& rings);

}  // namespace lxd
