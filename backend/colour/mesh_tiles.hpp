// SPDX-License-Identifier: Apache-2.0
// A sub-mesh's vertices and faces by the cube that they lie in, so that an image looks at what lies before it only.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "backend/colour/key_image.hpp"
#include "mapping/mesh.hpp"

namespace lxd {

// Part of a list.
struct TilePart {
  std::uint32_t first = 0, count = 0;

  template <typename T>
  [[nodiscard]] std::span<T> of(std::span<T> list) const {
    return list.subspan(first, count);
  }
};

struct MeshTile {
  Eigen::Vector3f middle_m;  // sub-mesh frame, of a ball around its faces and all that touch its vertices
  float radius_m = 0;
  TilePart vertices, faces;
};

class MeshTiles {
 public:
  // edge_m: of a cube.
  MeshTiles(std::span<const MeshVertex> vertices, std::span<const MeshFace> faces, float edge_m);

  [[nodiscard]] std::span<const MeshTile> tiles() const { return tiles_; }
  // The mesh's, in the tiles' order.
  [[nodiscard]] std::span<const MeshVertex> vertices() const { return vertices_; }
  [[nodiscard]] std::span<const MeshFace> faces() const { return faces_; }
  // Where a vertex was in the mesh.
  [[nodiscard]] std::uint32_t origin(std::size_t vertex) const { return origins_[vertex]; }

 private:
  void sort_vertices(std::span<const MeshVertex> vertices, float edge_m);
  void sort_faces(std::span<const MeshFace> faces);
  void enclose();

  std::vector<MeshTile> tiles_;
  std::vector<MeshVertex> vertices_;
  std::vector<MeshFace> faces_;
  std::vector<std::uint32_t> origins_, tile_of_;  // of each vertex here
};

// May an image show part of the tile, or what hides it? Up to range_max_m along the camera's axis.
bool may_show(const MeshTile& tile, const Pose& T_camera_mesh, const PinholeView& view, float range_max_m);

}  // namespace lxd
