// SPDX-License-Identifier: Apache-2.0
// The mesh while it is being built: vertices, faces, and around each vertex the list of its faces. No face is taken
// that would use a directed edge twice, so that every edge has at most two faces and these agree on the orientation.
// Storage is lent at construction; no allocation afterwards. One thread at a time.
#pragma once

#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "mapping/lattice.hpp"
#include "mapping/mesh.hpp"
#include "rt/arena.hpp"

namespace lxd {

// Axes of the layers that a vertex came from: bit a for axis a. Vertices welded across a seam have several.
using AxisMask = std::uint8_t;

class MeshTopology {
 public:
  MeshTopology(std::uint32_t vertices, std::uint32_t faces, Arena& arena);

  void clear() { vertex_count_ = face_count_ = 0; }

  // Index, or kNone when there is no room. variance: of the height along the layer's axis.
  std::uint32_t add_vertex(const Eigen::Vector3f& position_m, float variance_m2, AxisMask axes);

  enum class Added : std::uint8_t { yes, no_room, refused };
  // Counter-clockwise. Refused: a corner twice, or a directed edge that another face has.
  Added add_face(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  // The face that has the directed edge a -> b, or kNone.
  [[nodiscard]] std::uint32_t face_of_edge(std::uint32_t a, std::uint32_t b) const;
  // Has any face the directed edge a -> b? Told from the faces around b, where face_of_edge() asks those around a.
  [[nodiscard]] bool has_edge(std::uint32_t a, std::uint32_t b) const;
  [[nodiscard]] bool on_boundary(std::uint32_t vertex) const;

  // Calls visit(face, x, y) for every face (vertex, x, y) around a vertex, youngest first.
  template <typename Visit>
  void around(std::uint32_t vertex, Visit&& visit) const {
    for (std::uint32_t h = head_[vertex]; h != kNone; h = next_[h]) {
      const std::uint32_t face = h / 3, k = h % 3;
      visit(face, faces_[face][(k + 1) % 3], faces_[face][(k + 2) % 3]);
    }
  }

  // True when `gone` can become one with `kept` and every edge keeps at most two faces.
  [[nodiscard]] bool can_merge(std::uint32_t kept, std::uint32_t gone) const;
  // Precondition: can_merge. `gone` stays as a vertex without faces.
  void merge(std::uint32_t kept, std::uint32_t gone);

  // Normals of all vertices, weighted by the faces' areas.
  void update_normals();
  // Variances of heights become variances along the normals; once, before any merge.
  void project_variances();
  // Drops connected parts of fewer faces than these, and vertices without faces; the order stays. Last call: the lists
  // around vertices end here.
  void compact(std::uint8_t part_faces_min);

  [[nodiscard]] bool has_faces(std::uint32_t vertex) const { return head_[vertex] != kNone; }
  [[nodiscard]] AxisMask axes(std::uint32_t vertex) const { return axes_[vertex]; }
  [[nodiscard]] MeshVertex& vertex(std::uint32_t i) { return vertices_[i]; }
  [[nodiscard]] const MeshVertex& vertex(std::uint32_t i) const { return vertices_[i]; }
  // Not normalised: its length is twice the area.
  [[nodiscard]] Eigen::Vector3f face_normal(std::uint32_t face) const;
  [[nodiscard]] std::span<const MeshVertex> vertices() const { return vertices_.first(vertex_count_); }
  [[nodiscard]] std::span<const MeshFace> faces() const { return faces_.first(face_count_); }

 private:
  std::uint32_t root(std::uint32_t vertex);
  void join_parts();
  void drop_small_parts(std::uint8_t part_faces_min);

  std::span<MeshVertex> vertices_;
  std::span<AxisMask> axes_;
  std::span<std::uint32_t> head_;  // of each vertex: 3 * face + corner, or kNone
  std::span<MeshFace> faces_;
  std::span<std::uint32_t> next_;  // of each face's corner: the next one at its vertex
  std::uint32_t vertex_count_ = 0, face_count_ = 0;
};

}  // namespace lxd
