// SPDX-License-Identifier: Apache-2.0
// On which side of its layers was the LiDAR? Layers seen under flat angles only may have it wrong; the neighbours that
// continue their surface know better.
#pragma once

#include <cstdint>
#include <span>

#include "mapping/sub_mesh.hpp"

namespace lxd {

// sides[i]: +1 or -1 along the axis of layer i. A layer whose neighbours on the same surface mostly differ from it
// gives in.
void agree_on_sides(const SubMesh& sub_mesh, float cell_size_m, std::span<std::int8_t> sides);

}  // namespace lxd
