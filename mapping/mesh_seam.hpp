// SPDX-License-Identifier: Apache-2.0
// Closes the seams of a mesh whose patches lie over different axes: boundary vertices of two patches that meet become
// one, on the line where their planes cut; what gap is left, and narrow notches, get triangles between boundary
// vertices.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "mapping/mesh_topology.hpp"

namespace lxd {

// A boundary vertex in a grid of cubes, sorted by cube.
struct BoundaryEntry {
  std::uint64_t cube;
  std::uint32_t vertex;
};

class MeshSeam {
 public:
  // Works on `topology` in place. spacing: of the lattice. The normals must be up to date.
  MeshSeam(MeshTopology& topology, float spacing_m, std::span<BoundaryEntry> storage)
      : topology_(topology), spacing_m_(spacing_m), storage_(storage) {}

  // Boundary vertices that found no room in the storage stay open: their number is returned.
  std::uint64_t close();

 private:
  std::uint64_t collect_boundary();
  // What lay on no boundary does not come onto one; what had no room stays out.
  void collect_boundary_again();
  void sort_boundary(std::size_t count);
  void weld();
  void weld_to_nearest(std::uint32_t vertex);
  [[nodiscard]] std::uint32_t nearest_of_other_axis(std::uint32_t vertex);
  [[nodiscard]] Eigen::Vector3f meeting_point(std::uint32_t a, std::uint32_t b) const;
  [[nodiscard]] bool may_move(std::uint32_t vertex, const Eigen::Vector3f& to_m) const;
  std::uint64_t stitch();
  bool stitch_edge(std::uint32_t a, std::uint32_t b, std::uint32_t face);
  [[nodiscard]] bool is_free_direction(std::uint32_t vertex, const Eigen::Vector3f& towards_m) const;
  [[nodiscard]] bool fits(std::uint32_t a, std::uint32_t b, std::uint32_t c, const Eigen::Vector3f& face_normal) const;
  [[nodiscard]] std::uint64_t cube_of(const Eigen::Vector3f& p_m) const;

  template <typename Visit>
  void for_each_near(const Eigen::Vector3f& p_m, Visit&& visit);
  // The first boundary vertex of a cube or a later one, searched from where the last search ended.
  [[nodiscard]] std::size_t first_in(std::uint64_t cube, std::size_t from) const;

  MeshTopology& topology_;
  float spacing_m_;
  std::span<BoundaryEntry> storage_, boundary_;
  std::array<std::size_t, 9> found_{};  // of each column around: neighbours are asked for one after another
  std::uint64_t no_room_ = 0;
};

}  // namespace lxd
