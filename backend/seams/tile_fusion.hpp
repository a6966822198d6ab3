// SPDX-License-Identifier: Apache-2.0
// What becomes of the vertices of one tile (README, "Seams"): where several sub-meshes show one surface they are moved
// onto what all together say, and one of them is left to show it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "backend/seams/layers_here.hpp"
#include "backend/seams/seam_scale.hpp"
#include "backend/seams/seam_vertex.hpp"
#include "backend/seams/tile_grid.hpp"

namespace lxd {

class TileFusion {
 public:
  explicit TileFusion(const SeamScale& scale) : scale_(scale), grid_(scale), layers_(scale) {}

  // In place, of all that lie within the tile; what becomes of its halo is another tile's to say.
  void fuse(std::vector<SeamVertex>& vertices);

 private:
  [[nodiscard]] bool is_asked_for(const SeamVertex& v) const;
  [[nodiscard]] SeamVertex fused(const SeamVertex& v);
  [[nodiscard]] std::optional<SeamVertex> meeting_vertex(std::uint32_t rim) const;

  SeamScale scale_;
  TileGrid grid_;
  LayersHere layers_;
  std::span<const SeamVertex> vertices_;
  std::vector<SeamVertex> fused_;
};

}  // namespace lxd
