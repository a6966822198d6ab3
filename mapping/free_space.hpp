// SPDX-License-Identifier: Apache-2.0
// What moved while it was mapped leaves surfaces behind in places that beams go through before and after. README,
// "Free space".
#pragma once

#include <cstdint>
#include <span>

#include "mapping/beam.hpp"
#include "mapping/sub_mesh.hpp"

namespace lxd {

// Takes those of `quads` (of each layer, bits as in Layer::seen_quads) away that more beams went through than ended on.
// counts: room for kLayerQuads of each layer. Returns how many were taken. Low-priority thread.
std::uint64_t leave_out_passed(const SubMesh& sub_mesh, BeamSource& beams, float cell_size_m,
                               std::span<std::uint32_t> quads, std::span<std::uint32_t> counts) noexcept;

}  // namespace lxd
