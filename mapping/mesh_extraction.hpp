// SPDX-License-Identifier: Apache-2.0
// From a sub-mesh's layers to triangles whose faces share vertices (README, "Mesh extraction"). Beside the real-time
// path, but in storage that is lent at construction: no allocation, and what finds no room is counted. One thread at a
// time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "mapping/beam.hpp"
#include "mapping/config.hpp"
#include "mapping/lattice_entry.hpp"
#include "mapping/mesh.hpp"
#include "mapping/mesh_seam.hpp"
#include "mapping/mesh_topology.hpp"
#include "mapping/sub_mesh.hpp"
#include "rt/arena.hpp"

namespace lxd {

struct MeshCapacity {
  std::uint32_t layers;   // of the largest sub-mesh
  std::uint32_t corners;  // layer vertices of one axis that exported quads use: at most 36 a layer, mostly 20
  std::uint32_t vertices;
  std::uint32_t faces;
  std::uint32_t boundary;  // vertices on open edges, before seams are closed
};

// What found no room in the last extraction.
struct MeshCounters {
  std::uint64_t layers_lost = 0;  // beyond the capacity of layers
  std::uint64_t corners_lost = 0;
  std::uint64_t vertices_lost = 0;
  std::uint64_t faces_lost = 0;
  std::uint64_t trims_lost = 0;  // pulls at vertices of open edges, in the room that corners leave
  std::uint64_t seam_lost = 0;   // boundary vertices and faces that were left out where seams are closed
};

class MeshExtraction {
 public:
  struct Mesh {
    std::span<const MeshVertex> vertices;  // in the sub-mesh's frame: zero at SubMesh::origin(), axes of the world
    std::span<const MeshFace> faces;
  };

  MeshExtraction(const MappingConfig& config, const MeshCapacity& capacity, Arena& arena);

  // The fine cells' surfaces, without what its beams say is not there. Valid until the next call. Deterministic.
  Mesh extract(const SubMesh& sub_mesh, BeamSource& beams) noexcept;

  [[nodiscard]] const MeshCounters& counters() const { return counters_; }

 private:
  void choose_quads(const SubMesh& sub_mesh, BeamSource& beams);
  void collect_corners(const SubMesh& sub_mesh, int axis);
  void fuse_corners(const SubMesh& sub_mesh, int axis);
  void collect_quads(const SubMesh& sub_mesh, int axis);
  void emit_quads();
  [[nodiscard]] std::array<float, 4> overhang_of(const SubMesh& sub_mesh, std::uint32_t layer, int quad) const;
  void trim_quads(const SubMesh& sub_mesh);
  void add_entry(std::uint64_t key, float order, std::uint32_t slot);
  [[nodiscard]] std::array<std::uint32_t, 4> quad_vertices(std::uint32_t layer, int quad) const;
  void emit_quad(const std::array<std::uint32_t, 4>& quad, int side);
  void add_face(std::uint32_t a, std::uint32_t b, std::uint32_t c);

  float cell_size_m_, spacing_m_, variance_max_m2_;
  std::span<LatticeEntry> entries_;
  std::span<std::uint32_t> vertex_of_;  // of each layer's 36 vertices: the mesh's vertex, or kNone
  std::span<std::uint32_t> quads_;      // of each layer: those to export
  std::span<std::int8_t> sides_;        // of each layer: where the LiDAR was
  std::size_t beam_counts_, boundary_entries_;
  std::span<std::byte> lent_;       // to beams_, and when faces are made to the boundary
  std::span<std::uint32_t> beams_;  // of each layer: what beams said, kBeamCounts
  MeshTopology topology_;
  std::uint32_t entry_count_ = 0, layer_count_ = 0;
  MeshCounters counters_;
};

}  // namespace lxd
