// SPDX-License-Identifier: Apache-2.0
#include "backend/seams/fused_submesh.hpp"

#include <algorithm>

namespace lxd {
namespace {

// What became nothing or turned over where its rim was moved is not missed.
bool is_sound(const MeshFace& face, std::span<const MeshVertex> vertices) {
  constexpr float kHeightOfLength = 0.02F;
  const MeshVertex &a = vertices[face[0]], &b = vertices[face[1]], &c = vertices[face[2]];
  const Eigen::Vector3f ab = b.position_m - a.position_m, ac = c.position_m - a.position_m;
  const Eigen::Vector3f normal = (a.normal + b.normal + c.normal).normalized();
  return ab.cross(ac).dot(normal) > kHeightOfLength * std::max(ab.squaredNorm(), ac.squaredNorm());
}

}  // namespace

Status FusedSubmesh::fuse(const Pose& T_map_submesh, const TileStore& tiles, std::uint32_t number,
                          SubmeshSurface& surface) {
  fates_.assign(surface.vertices.size(), SeamFate::alone);
  if (Status moved = move_vertices(T_map_submesh, tiles, number, surface); !moved.ok()) return moved;
  std::erase_if(surface.faces, [&](const MeshFace& face) { return !shows(face, surface.vertices); });
  drop_unused(surface);
  return success();
}

Status FusedSubmesh::move_vertices(const Pose& T_map_submesh, const TileStore& tiles, std::uint32_t number,
                                   SubmeshSurface& surface) {
  auto& [vertices, faces, colours] = surface;
  const Pose T_submesh_map = T_map_submesh.inverse();
  for (const TileStore::Run& run : tiles.runs_of(number)) {
    run_.resize(run.inner);
    if (Status read = tiles.read(run, run_); !read.ok()) return read;
    for (const SeamVertex& v : run_) {
      if (v.fate == SeamFate::alone) continue;
      fates_[v.vertex] = v.fate;
      const Eigen::Vector3d p_map = tiles.corner_m(run.tile) + v.position_m.cast<double>();
      vertices[v.vertex] = {(T_submesh_map * p_map).cast<float>(),
                            (T_submesh_map.R * v.normal.cast<double>()).cast<float>(), v.variance_m2};
      if (v.colour.known() && colours.empty()) colours.resize(vertices.size());
      if (!colours.empty()) colours[v.vertex] = v.colour;
    }
  }
  return success();
}

// Where a rim runs between what its sub-mesh shows and what a later one does, the earlier one goes on to meet it; the
// later one ends.
bool FusedSubmesh::shows(const MeshFace& face, std::span<const MeshVertex> vertices) const {
  const auto is = [&](SeamFate fate) { return std::ranges::count(face, fate, [&](auto v) { return fates_[v]; }); };
  const auto to_later = is(SeamFate::to_later), to_earlier = is(SeamFate::to_earlier);
  if (to_earlier > 0 || to_later == 3) return false;
  return to_later == 0 || is_sound(face, vertices);
}

void FusedSubmesh::drop_unused(SubmeshSurface& surface) {
  constexpr std::uint32_t kUnused = 0xFFFFFFFF;
  auto& [vertices, faces, colours] = surface;
  places_.assign(vertices.size(), kUnused);
  for (std::size_t i = 0; i < vertices.size(); ++i)
    if (fates_[i] == SeamFate::alone) places_[i] = 0;  // with or without faces, as it was
  for (const MeshFace& face : faces)
    for (const std::uint32_t v : face) places_[v] = 0;
  std::uint32_t left = 0;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    if (places_[i] == kUnused) continue;
    vertices[left] = vertices[i];
    if (!colours.empty()) colours[left] = colours[i];
    places_[i] = left++;
  }
  vertices.resize(left);
  if (!colours.empty()) colours.resize(left);
  for (MeshFace& face : faces)
    for (std::uint32_t& v : face) v = places_[v];
}

}  // namespace lxd
