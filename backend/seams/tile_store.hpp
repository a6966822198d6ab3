// SPDX-License-Identifier: Apache-2.0
// The vertices of all sub-meshes by place, on the disk: cubes of the map ("tiles"), each with what lies around it, so
// that one tile at a time tells what becomes of its vertices. In memory is 32 bytes for each tile of each sub-mesh.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "backend/archive.hpp"
#include "backend/scratch_file.hpp"
#include "backend/seams/seam_scale.hpp"
#include "backend/seams/seam_vertex.hpp"
#include "mapping/lattice.hpp"

namespace lxd {

class TileStore {
 public:
  // One sub-mesh's vertices in one tile: first those within the tile, then its halo, both in the mesh's order.
  struct Run {
    CellKey tile;
    std::uint32_t submesh;
    std::uint32_t inner, halo;  // vertices
    std::uint64_t first;        // vertex of the file
  };

  static Result<TileStore> create(const std::filesystem::path& folder, const SeamScale& scale);

  // rings: of each vertex. What has no finite place stays out.
  Status append(const SubmeshView& submesh, std::span<const std::uint8_t> rings);

  // Once, after the last sub-mesh: the tiles that at least two of them are in, each the runs of all, in their order.
  [[nodiscard]] std::vector<std::span<const Run>> shared_tiles();

  Status read(const Run& run, std::span<SeamVertex> vertices) const;  // inner and halo
  Status write(const Run& run, std::span<const SeamVertex> inner);

  // Of one sub-mesh, of shared tiles, once these are known.
  [[nodiscard]] std::span<const Run> runs_of(std::uint32_t submesh) const;
  // The tile's lowest corner in the map.
  [[nodiscard]] Eigen::Vector3d corner_m(CellKey tile) const { return unpack(tile).cast<double>() * scale_.tile_m(); }

 private:
  TileStore(ScratchFile file, const SeamScale& scale) : file_(std::move(file)), scale_(scale) {}
  [[nodiscard]] bool is_shared(CellKey tile) const;

  ScratchFile file_;
  SeamScale scale_;
  std::uint32_t submeshes_ = 0;
  std::uint64_t vertices_ = 0;  // in the file
  std::vector<Run> runs_;       // in order of sub-mesh
  std::vector<Run> by_tile_;    // shared ones
};

}  // namespace lxd
