// SPDX-License-Identifier: Apache-2.0
#include "backend/seams/layers_here.hpp"

#include <cmath>

namespace lxd {
namespace {

// Normals of one surface: those of its rounded edges, too, but never the other side of a wall.
constexpr float kAlikeCosine = 0.6F;
// Sigmas of variances and poses together that layers of one surface may lie apart.
constexpr float kGateSigmas = 3;
// Sheets of one sub-mesh that lie farther apart than this, in spacings, are two; the nearest one is meant.
constexpr float kSheet = 0.5F;
// Rings are counted in parts of one, so that layers that are equally far from their rims are equal.
constexpr float kRingParts = 8;

}  // namespace

std::span<const LayerHere> LayersHere::find(const SeamVertex& at, std::span<const SeamVertex> vertices,
                                            const TileGrid& grid) {
  gather(at, vertices, grid);
  const float kernel_m2 = scale_.kernel_m() * scale_.kernel_m();
  for (const Near& near : near_) {
    LayerHere& layer = layers_[near.layer];
    if (std::abs(near.height_m - layer.nearest_height_m) > kSheet * scale_.spacing_m) continue;
    const SeamVertex& v = vertices[near.vertex];
    const float share = 1 - near.along_m2 / kernel_m2, weight = share * share;
    layer.weight += weight;
    layer.height_m += weight * near.height_m;
    layer.variance_m2 += weight * v.variance_m2;
    layer.rings += weight * static_cast<float>(v.rings);
    layer.normal += weight * v.normal;
  }
  for (LayerHere& layer : layers_) {
    layer.height_m /= layer.weight;
    layer.variance_m2 /= layer.weight;
    layer.rings = std::round(layer.rings / layer.weight * kRingParts) / kRingParts;
  }
  layers_.front().height_m = 0;
  layers_.front().variance_m2 = at.variance_m2;
  std::erase_if(layers_, [&](const LayerHere& layer) {
    const float variance_m2 = layer.variance_m2 + at.variance_m2 + kPoseResidual_m * kPoseResidual_m;
    return layer.height_m * layer.height_m > kGateSigmas * kGateSigmas * variance_m2;
  });
  return layers_;
}

void LayersHere::gather(const SeamVertex& at, std::span<const SeamVertex> vertices, const TileGrid& grid) {
  layers_.clear();
  near_.clear();
  layer_of(at.submesh);
  grid.for_each_near(at.position_m, [&](std::uint32_t i) { add(at, vertices[i], i); });
}

void LayersHere::add(const SeamVertex& at, const SeamVertex& other, std::uint32_t vertex) {
  const Eigen::Vector3f offset_m = other.position_m - at.position_m;
  const float distance_m2 = offset_m.squaredNorm();
  const float cosine = other.normal.dot(at.normal);
  if (cosine < kAlikeCosine) return;
  const float above_m = offset_m.dot(at.normal);
  const float along_m2 = distance_m2 - above_m * above_m;
  const float height_m = other.normal.dot(offset_m) / cosine;
  if (along_m2 >= scale_.kernel_m() * scale_.kernel_m() || std::abs(height_m) > kLayerGapMax_m) return;
  const std::uint32_t index = layer_of(other.submesh);
  near_.push_back({vertex, index, height_m, along_m2});
  LayerHere& layer = layers_[index];
  const bool is_first = layer.nearest_m2 < 0;
  if (!is_first && distance_m2 >= layer.nearest_m2) return;
  layer.nearest = vertex;
  layer.nearest_m2 = distance_m2;
  layer.nearest_height_m = height_m;
}

std::uint32_t LayersHere::layer_of(std::uint32_t submesh) {
  for (std::uint32_t i = 0; i < layers_.size(); ++i)
    if (layers_[i].submesh == submesh) return i;
  layers_.push_back({.submesh = submesh, .nearest_m2 = -1});
  return static_cast<std::uint32_t>(layers_.size() - 1);
}

}  // namespace lxd
