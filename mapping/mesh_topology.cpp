// SPDX-License-Identifier: Apache-2.0
#include "mapping/mesh_topology.hpp"

#include <algorithm>
#include <bit>

#include <Eigen/Geometry>

namespace lxd {

MeshTopology::MeshTopology(std::uint32_t vertices, std::uint32_t faces, Arena& arena)
    : vertices_(arena.take<MeshVertex>("mesh vertices", vertices)),
      axes_(arena.take<AxisMask>("mesh vertex axes", vertices)),
      head_(arena.take<std::uint32_t>("mesh vertex lists", vertices)),
      faces_(arena.take<MeshFace>("mesh faces", faces)),
      next_(arena.take<std::uint32_t>("mesh face lists", std::size_t{faces} * 3)) {}

std::uint32_t MeshTopology::add_vertex(const Eigen::Vector3f& position_m, float variance_m2, AxisMask axes) {
  if (vertex_count_ == vertices_.size()) return kNone;
  vertices_[vertex_count_] = {position_m, Eigen::Vector3f::Zero(), variance_m2};
  axes_[vertex_count_] = axes;
  head_[vertex_count_] = kNone;
  return vertex_count_++;
}

MeshTopology::Added MeshTopology::add_face(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (a == b || b == c || c == a) return Added::refused;
  if (face_of_edge(a, b) != kNone || face_of_edge(b, c) != kNone || face_of_edge(c, a) != kNone) return Added::refused;
  if (face_count_ == faces_.size()) return Added::no_room;
  const MeshFace face{a, b, c};
  faces_[face_count_] = face;
  for (std::uint32_t k = 0; k < 3; ++k) {
    const std::uint32_t corner = 3 * face_count_ + k;
    next_[corner] = head_[face[k]];
    head_[face[k]] = corner;
  }
  ++face_count_;
  return Added::yes;
}

std::uint32_t MeshTopology::face_of_edge(std::uint32_t a, std::uint32_t b) const {
  for (std::uint32_t h = head_[a]; h != kNone; h = next_[h])
    if (faces_[h / 3][(h % 3 + 1) % 3] == b) return h / 3;
  return kNone;
}

// Of a face (b, x, y) the edge y -> b is at b.
bool MeshTopology::has_edge(std::uint32_t a, std::uint32_t b) const {
  for (std::uint32_t h = head_[b]; h != kNone; h = next_[h])
    if (faces_[h / 3][(h % 3 + 2) % 3] == a) return true;
  return false;
}

// As many edges end at a vertex as begin there, each once: when all that begin are closed, so are those that end.
bool MeshTopology::on_boundary(std::uint32_t vertex) const {
  for (std::uint32_t h = head_[vertex]; h != kNone; h = next_[h])
    if (!has_edge(faces_[h / 3][(h % 3 + 1) % 3], vertex)) return true;
  return false;
}

bool MeshTopology::can_merge(std::uint32_t kept, std::uint32_t gone) const {
  bool possible = kept != gone;
  around(gone, [&](std::uint32_t, std::uint32_t x, std::uint32_t y) {
    possible = possible && x != kept && y != kept && face_of_edge(kept, x) == kNone && face_of_edge(y, kept) == kNone;
  });
  return possible;
}

void MeshTopology::merge(std::uint32_t kept, std::uint32_t gone) {
  axes_[kept] |= axes_[gone];
  while (head_[gone] != kNone) {
    const std::uint32_t h = head_[gone];
    head_[gone] = next_[h];
    faces_[h / 3][h % 3] = kept;
    next_[h] = head_[kept];
    head_[kept] = h;
  }
}

Eigen::Vector3f MeshTopology::face_normal(std::uint32_t face) const {
  const MeshFace& f = faces_[face];
  const Eigen::Vector3f& a = vertices_[f[0]].position_m;
  return (vertices_[f[1]].position_m - a).cross(vertices_[f[2]].position_m - a);
}

void MeshTopology::update_normals() {
  for (MeshVertex& v : vertices_.first(vertex_count_)) v.normal.setZero();
  for (std::uint32_t f = 0; f < face_count_; ++f) {
    const Eigen::Vector3f normal = face_normal(f);
    for (const std::uint32_t v : faces_[f]) vertices_[v].normal += normal;
  }
  for (MeshVertex& v : vertices_.first(vertex_count_)) v.normal.stableNormalize();
}

void MeshTopology::project_variances() {
  for (std::uint32_t i = 0; i < vertex_count_; ++i) {
    const float cosine = vertices_[i].normal[std::countr_zero(axes_[i])];
    if (has_faces(i)) vertices_[i].variance_m2 *= cosine * cosine;
  }
}

void MeshTopology::compact(std::uint8_t part_faces_min) {
  join_parts();
  drop_small_parts(part_faces_min);
  for (const MeshFace& face : faces_.first(face_count_))
    for (const std::uint32_t v : face) head_[v] = 0;
  std::uint32_t kept = 0;
  for (std::uint32_t i = 0; i < vertex_count_; ++i) {
    if (head_[i] == kNone) continue;
    vertices_[kept] = vertices_[i];
    head_[i] = kept++;  // the vertex's new place
  }
  for (MeshFace& face : faces_.first(face_count_))
    for (std::uint32_t& v : face) v = head_[v];
  vertex_count_ = kept;
}

// Union-find over vertices, in the storage of the lists: head_ becomes the parent.
std::uint32_t MeshTopology::root(std::uint32_t vertex) {
  while (head_[vertex] != vertex) vertex = head_[vertex] = head_[head_[vertex]];
  return vertex;
}

void MeshTopology::join_parts() {
  for (std::uint32_t i = 0; i < vertex_count_; ++i) head_[i] = i;
  for (const MeshFace& face : faces_.first(face_count_)) {
    const std::uint32_t a = root(face[0]);
    head_[root(face[1])] = a;
    head_[root(face[2])] = a;
  }
}

void MeshTopology::drop_small_parts(std::uint8_t part_faces_min) {
  // Axes are no more asked for: their storage counts the faces of the part whose root a vertex is, up to 255.
  const auto count = axes_.first(vertex_count_);
  std::fill(count.begin(), count.end(), AxisMask{0});
  for (const MeshFace& face : faces_.first(face_count_)) {
    AxisMask& n = count[root(face[0])];
    n = static_cast<AxisMask>(std::min(n + 1, 255));
  }
  std::uint32_t kept = 0;
  for (std::uint32_t f = 0; f < face_count_; ++f)
    if (count[root(faces_[f][0])] >= part_faces_min) faces_[kept++] = faces_[f];
  face_count_ = kept;
  std::fill(head_.begin(), head_.begin() + vertex_count_, kNone);
}

}  // namespace lxd
