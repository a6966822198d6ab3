// SPDX-License-Identifier: Apache-2.0
// One sub-mesh with its vertices where the map has them and without what others show in its stead.
#pragma once

#include <cstdint>
#include <vector>

#include "backend/archive.hpp"
#include "backend/seams/tile_store.hpp"

namespace lxd {

// Reused from one sub-mesh to the next.
class FusedSubmesh {
 public:
  // In place. number: of the sub-mesh in the archive's order.
  Status fuse(const Pose& T_map_submesh, const TileStore& tiles, std::uint32_t number, SubmeshSurface& surface);

 private:
  Status move_vertices(const Pose& T_map_submesh, const TileStore& tiles, std::uint32_t number,
                       SubmeshSurface& surface);
  [[nodiscard]] bool shows(const MeshFace& face, std::span<const MeshVertex> vertices) const;
  void drop_unused(SubmeshSurface& surface);

  std::vector<SeamFate> fates_;
  std::vector<std::uint32_t> places_;
  std::vector<SeamVertex> run_;
};

}  // namespace lxd
