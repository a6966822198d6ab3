// SPDX-License-Identifier: Apache-2.0
// What beams say of layers. What moved while it was mapped leaves surfaces behind in places that beams go through
// before and after; and a layer's front is where beams that end on it come from. README, "Free space".
#pragma once

#include <cstdint>
#include <span>

#include "mapping/beam.hpp"
#include "mapping/sub_mesh.hpp"

namespace lxd {

inline constexpr std::size_t kBeamCounts = kLayerQuads + 1;

// Of each layer.
struct LayerVerdicts {
  std::span<std::uint32_t> quads;   // to export, bits as in Layer::seen_quads: those that more beams went through than
                                    // ended on go
  std::span<std::int8_t> sides;     // +1 or -1: on which side along its axis the LiDAR was; stays where no beams tell
  std::span<std::uint32_t> counts;  // room for kBeamCounts of each, to work in
};

// Low-priority thread.
void judge_by_beams(const SubMesh& sub_mesh, BeamSource& beams, float cell_size_m,
                    const LayerVerdicts& verdicts) noexcept;

}  // namespace lxd
