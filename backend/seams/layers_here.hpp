// SPDX-License-Identifier: Apache-2.0
// The layers of the surface that a vertex is on, its own sub-mesh's and the others': how high above it, how well known
// and how far from their rims they are, there.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "backend/seams/seam_scale.hpp"
#include "backend/seams/seam_vertex.hpp"
#include "backend/seams/tile_grid.hpp"

namespace lxd {

// Means over the vertices around, the nearer the more.
struct LayerHere {
  std::uint32_t submesh = 0;
  std::uint32_t nearest = 0;  // vertex
  float nearest_m2 = 0;       // squared distance
  float nearest_height_m = 0;
  float weight = 0;  // sum
  float height_m = 0, variance_m2 = 0, rings = 0;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
};

class LayersHere {
 public:
  explicit LayersHere(const SeamScale& scale) : scale_(scale) {}

  // First the vertex's own, whose height is 0; then those that may be the same surface. Valid until the next call.
  // vertices: what the grid holds, `at` among them.
  std::span<const LayerHere> find(const SeamVertex& at, std::span<const SeamVertex> vertices, const TileGrid& grid);

 private:
  struct Near {
    std::uint32_t vertex, layer;
    float height_m, along_m2;  // of its tangent plane over `at`; squared distance along the surface
  };
  void gather(const SeamVertex& at, std::span<const SeamVertex> vertices, const TileGrid& grid);
  void add(const SeamVertex& at, const SeamVertex& other, std::uint32_t vertex);
  std::uint32_t layer_of(std::uint32_t submesh);

  SeamScale scale_;
  std::vector<LayerHere> layers_;
  std::vector<Near> near_;
};

}  // namespace lxd
