// SPDX-License-Identifier: Apache-2.0
// One sub-mesh with its vertices where the map has them and without what others show in its stead.
#pragma once

#include <cstdint>
#include <vector>

#include "backend/archive.hpp"
#include "backend/seams/tile_store.hpp"

namespace lxd {

class FusedSubmesh {
 public:
  // number: of the sub-mesh in the archive's order.
  Status assemble(const SubmeshView& submesh, const TileStore& tiles, std::uint32_t number);

  // Valid until the next assemble().
  [[nodiscard]] const SubmeshView& view() const { return view_; }

 private:
  Status move_vertices(const TileStore& tiles, std::uint32_t number);
  [[nodiscard]] bool shows(const MeshFace& face, std::span<const MeshVertex> before) const;
  void drop_unused();

  SubmeshView view_;
  std::vector<MeshVertex> vertices_;
  std::vector<VertexColour> colours_;
  std::vector<MeshFace> faces_;
  std::vector<SeamFate> fates_;
  std::vector<std::uint32_t> places_;
  std::vector<SeamVertex> run_;
};

}  // namespace lxd
