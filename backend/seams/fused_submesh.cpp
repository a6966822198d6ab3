// SPDX-License-Identifier: Apache-2.0
#include "backend/seams/fused_submesh.hpp"

#include <algorithm>

namespace lxd {
namespace {

Eigen::Vector3f area_vector(const MeshFace& face, std::span<const MeshVertex> vertices) {
  const Eigen::Vector3f& a = vertices[face[0]].position_m;
  return (vertices[face[1]].position_m - a).cross(vertices[face[2]].position_m - a);
}

}  // namespace

Status FusedSubmesh::assemble(const SubmeshView& submesh, const TileStore& tiles, std::uint32_t number) {
  view_ = submesh;
  vertices_.assign(submesh.vertices.begin(), submesh.vertices.end());
  colours_.assign(submesh.colours.begin(), submesh.colours.end());
  fates_.assign(vertices_.size(), SeamFate::alone);
  if (Status moved = move_vertices(tiles, number); !moved.ok()) return moved;
  faces_.clear();
  std::ranges::copy_if(submesh.faces, std::back_inserter(faces_),
                       [&](const MeshFace& face) { return shows(face, submesh.vertices); });
  drop_unused();
  view_.vertices = vertices_;
  view_.colours = colours_;
  view_.faces = faces_;
  return success();
}

Status FusedSubmesh::move_vertices(const TileStore& tiles, std::uint32_t number) {
  const Pose T_submesh_map = view_.T_map_submesh.inverse();
  for (const TileStore::Run& run : tiles.runs_of(number)) {
    run_.resize(run.inner);
    if (Status read = tiles.read(run, run_); !read.ok()) return read;
    for (const SeamVertex& v : run_) {
      if (v.fate == SeamFate::alone) continue;
      fates_[v.vertex] = v.fate;
      const Eigen::Vector3d p_map = tiles.corner_m(run.tile) + v.position_m.cast<double>();
      vertices_[v.vertex] = {(T_submesh_map * p_map).cast<float>(),
                             (T_submesh_map.R * v.normal.cast<double>()).cast<float>(), v.variance_m2};
      if (v.colour.known() && colours_.empty()) colours_.resize(vertices_.size());
      if (!colours_.empty()) colours_[v.vertex] = v.colour;
    }
  }
  return success();
}

// Where a rim runs between what its sub-mesh shows and what a later one does, the earlier one goes on to meet it; the
// later one ends.
bool FusedSubmesh::shows(const MeshFace& face, std::span<const MeshVertex> before) const {
  const auto is = [&](SeamFate fate) { return std::ranges::count(face, fate, [&](auto v) { return fates_[v]; }); };
  const auto to_later = is(SeamFate::to_later);
  if (to_later == 0 && is(SeamFate::to_earlier) == 0) return true;
  if (is(SeamFate::to_earlier) > 0 || to_later == 3) return false;
  // What became nothing or turned over where its rim was moved is not missed.
  constexpr float kAreaLeft = 0.02F;
  const Eigen::Vector3f was = area_vector(face, before);
  return area_vector(face, vertices_).dot(was) > kAreaLeft * was.squaredNorm();
}

void FusedSubmesh::drop_unused() {
  constexpr std::uint32_t kUnused = 0xFFFFFFFF;
  places_.assign(vertices_.size(), kUnused);
  for (std::size_t i = 0; i < vertices_.size(); ++i)
    if (fates_[i] == SeamFate::alone) places_[i] = 0;  // with or without faces, as it was
  for (const MeshFace& face : faces_)
    for (const std::uint32_t v : face) places_[v] = 0;
  std::uint32_t left = 0;
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    if (places_[i] == kUnused) continue;
    vertices_[left] = vertices_[i];
    if (!colours_.empty()) colours_[left] = colours_[i];
    places_[i] = left++;
  }
  vertices_.resize(left);
  if (!colours_.empty()) colours_.resize(left);
  for (MeshFace& face : faces_)
    for (std::uint32_t& v : face) v = places_[v];
}

}  // namespace lxd
