// SPDX-License-Identifier: Apache-2.0
// On which side of its layers was the LiDAR? Layers seen under flat angles only may have it wrong; the layers that
// continue their surface know better.
#pragma once

#include <cstdint>
#include <span>

#include "mapping/sub_mesh.hpp"

namespace lxd {

// sides[i]: +1 or -1 along the axis of layer i: what most layers of its surface have. All spans have the same size;
// `surface` and `votes` are storage to work in.
void agree_on_sides(const SubMesh& sub_mesh, float cell_size_m, std::span<std::int8_t> sides,
                    std::span<std::uint32_t> surface, std::span<std::uint32_t> votes);

}  // namespace lxd
