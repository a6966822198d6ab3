// SPDX-License-Identifier: Apache-2.0
#include "backend/seams/tile_fusion.hpp"

#include <algorithm>
#include <cmath>

#include "backend/seams/rim_distance.hpp"

namespace lxd {
namespace {

// A layer covers a place when the vertices around are, on average, this far within it: its outermost ones do not.
constexpr float kCoveringRings = 0.75F;
// What a layer's rim weighs against its inside: nothing, unless there are only rims.
constexpr float kRimWeight = 1e-3F;
constexpr float kVarianceMin_m2 = 1e-8F;
constexpr float kSameSideCosine = 0.6F;

// From the rim inwards a layer counts more and more, without a kink: at its rim the others' surface is met.
float inwards(float rings) {
  const float part = std::min(rings / kRingsMax, 1.0F);
  return std::max(part * part * (3 - 2 * part), kRimWeight);
}

// The weighted mean of layers, by inverse variance and rim.
struct Mean {
  float weight = 0, height_m = 0, square_m2 = 0, variance = 0, share_max = 0;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();
  int layers = 0;

  void add(const LayerHere& layer, const Eigen::Vector3f& layer_normal) {
    const float share = inwards(layer.rings), w = share / std::max(layer.variance_m2, kVarianceMin_m2);
    share_max = std::max(share_max, share);
    weight += w;
    height_m += w * layer.height_m;
    square_m2 += w * layer.height_m * layer.height_m;
    variance += w * share;
    normal += w * layer_normal.normalized();
    ++layers;
  }

  [[nodiscard]] float mean_height_m() const { return height_m / weight; }

  // Of independent errors; more where the layers do not agree as they should (the Birge ratio), for the poses'.
  [[nodiscard]] float mean_variance_m2() const {
    const float chi2 = std::max(square_m2 - height_m * height_m / weight, 0.0F) / share_max;
    return variance / (weight * weight) * std::max(1.0F, chi2 / static_cast<float>(layers - 1));
  }
};

// The layer that is farthest within its sub-mesh shows the surface, of equals the earliest.
SeamFate fate_of(std::span<const LayerHere> layers) {
  const LayerHere& own = layers.front();
  const LayerHere* best = &own;
  for (const LayerHere& layer : layers.subspan(1)) {
    const bool farther = layer.rings > best->rings, equal = layer.rings == best->rings;
    if (layer.rings >= kCoveringRings && (farther || (equal && layer.submesh < best->submesh))) best = &layer;
  }
  if (best == &own) return SeamFate::fused;
  return best->submesh > own.submesh ? SeamFate::to_later : SeamFate::to_earlier;
}

}  // namespace

void TileFusion::fuse(std::vector<SeamVertex>& vertices) {
  vertices_ = vertices;
  grid_.build(vertices);
  fused_.assign(vertices.begin(), vertices.end());
  for (SeamVertex& v : fused_)
    if (is_asked_for(v)) v = fused(v);
  for (std::uint32_t i = 0; i < vertices.size(); ++i) {
    if (vertices[i].in_halo) continue;
    const auto met = fused_[i].fate == SeamFate::to_later ? meeting_vertex(i) : std::nullopt;
    SeamVertex& v = vertices[i];
    const SeamVertex& becomes = met ? *met : fused_[i];
    v.position_m = becomes.position_m;
    v.normal = becomes.normal;
    v.variance_m2 = becomes.variance_m2;
    v.colour = becomes.colour;
    v.fate = fused_[i].fate;
  }
}

// Rims within the tile may meet vertices of the halo.
bool TileFusion::is_asked_for(const SeamVertex& v) const {
  const float margin_m = scale_.snap_m();
  return !v.in_halo || (v.position_m.minCoeff() >= -margin_m && v.position_m.maxCoeff() <= scale_.tile_m() + margin_m);
}

SeamVertex TileFusion::fused(const SeamVertex& v) {
  const std::span<const LayerHere> layers = layers_.find(v, vertices_, grid_);
  if (layers.size() == 1) return v;
  Mean mean;
  mean.add(layers.front(), v.normal);
  SeamVertex out = v;
  float nearest_m2 = scale_.reach_m() * scale_.reach_m();
  for (const LayerHere& layer : layers.subspan(1)) {
    mean.add(layer, layer.normal);
    const VertexColour colour = vertices_[layer.nearest].colour;
    if (v.colour.known() || !colour.known() || layer.nearest_m2 > nearest_m2) continue;
    nearest_m2 = layer.nearest_m2;
    out.colour = colour;
  }
  out.position_m += mean.mean_height_m() * v.normal;
  out.normal = mean.normal.normalized();
  out.variance_m2 = mean.mean_variance_m2();
  out.fate = fate_of(layers);
  return out;
}

// The nearest vertex around of a sub-mesh that shows the surface there: a rim that ends before another goes on in it.
std::optional<SeamVertex> TileFusion::meeting_vertex(std::uint32_t rim) const {
  const SeamVertex& v = vertices_[rim];
  std::optional<std::uint32_t> nearest;
  float nearest_m2 = scale_.snap_m() * scale_.snap_m();
  grid_.for_each_near(v.position_m, [&](std::uint32_t i) {
    const SeamVertex& other = fused_[i];
    if (other.submesh == v.submesh || !other.stays() || !(other.normal.dot(v.normal) > kSameSideCosine)) return;
    const float distance_m2 = (other.position_m - fused_[rim].position_m).squaredNorm();
    if (distance_m2 >= nearest_m2) return;
    nearest = i;
    nearest_m2 = distance_m2;
  });
  return nearest ? std::optional(fused_[*nearest]) : std::nullopt;
}

}  // namespace lxd
