// SPDX-License-Identifier: Apache-2.0
#include "backend/seams/fused_map.hpp"

#include <algorithm>
#include <numeric>
#include <vector>

#include "backend/seams/fused_submesh.hpp"
#include "backend/seams/rim_distance.hpp"
#include "backend/seams/tile_fusion.hpp"

namespace lxd {
namespace {

// Of the map: the coarsest of its sub-meshes', should sessions differ. 0: it has no faces.
Result<float> spacing_of(const Archive& archive) {
  float spacing_m = 0;
  const Status read = archive.for_each_submesh([&](const SubmeshView& submesh) {
    spacing_m = std::max(spacing_m, edge_length_m(submesh.vertices, submesh.faces));
    return success();
  });
  if (!read.ok()) return read.error();
  return spacing_m;
}

}  // namespace

Result<FusedMap> FusedMap::create(const Archive& archive, const std::filesystem::path& folder) {
  FusedMap map(archive);
  if (archive.totals().submeshes < 2) return map;
  const Result<float> spacing_m = spacing_of(archive);
  if (!spacing_m.ok()) return spacing_m.error();
  if (!(*spacing_m > 0)) return map;
  const SeamScale scale{*spacing_m};
  if (const Status stored = map.store(folder, scale); !stored.ok()) return stored.error();
  if (const Status fused = map.fuse_tiles(scale); !fused.ok()) return fused.error();
  if (const Status counted = map.count(); !counted.ok()) return counted.error();
  return map;
}

Status FusedMap::store(const std::filesystem::path& folder, const SeamScale& scale) {
  Result<TileStore> tiles = TileStore::create(folder, scale);
  if (!tiles.ok()) return tiles.error();
  tiles_.emplace(std::move(*tiles));
  std::vector<std::uint8_t> rings;
  return archive_->for_each_submesh([&](const SubmeshView& submesh) {
    measure_rim_distance(submesh.vertices.size(), submesh.faces, rings);
    return tiles_->append(submesh, rings);
  });
}

Status FusedMap::fuse_tiles(const SeamScale& scale) {
  TileFusion fusion(scale);
  std::vector<SeamVertex> vertices;
  for (const std::span<const TileStore::Run> tile : tiles_->shared_tiles()) {
    vertices.resize(std::accumulate(tile.begin(), tile.end(), std::size_t{0},
                                    [](std::size_t sum, const auto& run) { return sum + run.inner + run.halo; }));
    std::span<SeamVertex> room = vertices;
    for (const TileStore::Run& run : tile) {
      const std::size_t count = run.inner + run.halo;
      if (const Status read = tiles_->read(run, room.first(count)); !read.ok()) return read;
      room = room.subspan(count);
    }
    fusion.fuse(vertices);
    std::span<const SeamVertex> rest = vertices;
    for (const TileStore::Run& run : tile) {
      if (const Status written = tiles_->write(run, rest.first(run.inner)); !written.ok()) return written;
      rest = rest.subspan(run.inner + run.halo);
    }
  }
  return success();
}

Status FusedMap::count() {
  std::uint64_t vertices = 0, faces = 0;
  const Status read = for_each_submesh([&](const SubmeshView& submesh) {
    vertices += submesh.vertices.size();
    faces += submesh.faces.size();
    return success();
  });
  totals_.vertices = vertices;
  totals_.faces = faces;
  return read;
}

Status FusedMap::for_each_submesh(const Archive::SubmeshVisitor& visit) const {
  if (!tiles_) return archive_->for_each_submesh(visit);
  FusedSubmesh fusion;
  std::uint32_t number = 0;
  return archive_->edit_each_submesh([&](const SubmeshView& submesh, SubmeshSurface& surface) {
    const Status fused = fusion.fuse(submesh.T_map_submesh, *tiles_, number++, surface);
    if (!fused.ok()) return fused;
    SubmeshView view = submesh;
    view.vertices = surface.vertices;
    view.faces = surface.faces;
    view.colours = surface.colours;
    return visit(view);
  });
}

}  // namespace lxd
