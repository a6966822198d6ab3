// SPDX-License-Identifier: Apache-2.0
#include "mapping/mesh_sides.hpp"

#include <cmath>

namespace lxd {
namespace {

constexpr std::uint32_t kBalance = 0x80000000u;  // as many votes for either side
constexpr float kSameSurface = 0.3f;             // spacings between two layers' heights at their border

// Mean height of the two middle vertices on the border towards (du, dv).
float border_height(const Layer& layer, int du, int dv) {
  constexpr int m = kVerticesPerEdge / 2, last = kVerticesPerEdge - 1;
  const auto at = [&](int u, int v) { return layer.height_m[v * kVerticesPerEdge + u]; };
  if (du != 0) return 0.5f * (at(du > 0 ? last : 0, m - 1) + at(du > 0 ? last : 0, m));
  return 0.5f * (at(m - 1, dv > 0 ? last : 0) + at(m, dv > 0 ? last : 0));
}

class Surfaces {
 public:
  Surfaces(const SubMesh& sub_mesh, float cell_size_m, std::span<std::uint32_t> parent)
      : sub_mesh_(sub_mesh),
        cell_size_m_(cell_size_m),
        tolerance_m_(kSameSurface * cell_size_m / kQuadsPerEdge),
        parent_(parent) {
    for (std::uint32_t i = 0; i < parent.size(); ++i) parent_[i] = i;
  }

  std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  // Joins layer i with those beyond its border towards (du, dv) that continue it.
  void join_beyond(std::uint32_t i, int du, int dv) {
    const Layer& layer = sub_mesh_.layer(i);
    const float height = border_height(layer, du, dv);
    for (int dw = -1; dw <= 1; ++dw) {
      CellIndex index = sub_mesh_.cells()[layer.cell].index;
      index[axis_u(layer.axis)] += du;
      index[axis_v(layer.axis)] += dv;
      index[layer.axis] += dw;
      const std::uint32_t found = sub_mesh_.find(index);
      if (found != kNone) join_in(sub_mesh_.cells()[found], i, du, dv, height - static_cast<float>(dw) * cell_size_m_);
    }
  }

 private:
  void join_in(const Cell& cell, std::uint32_t i, int du, int dv, float height_m) {
    for (std::uint32_t k = 0; k < cell.layer_count; ++k) {
      const Layer& other = sub_mesh_.layer(cell.layers[k]);
      if (other.axis != sub_mesh_.layer(i).axis || cell.layers[k] >= parent_.size()) continue;
      if (std::abs(border_height(other, -du, -dv) - height_m) < tolerance_m_) parent_[root(cell.layers[k])] = root(i);
    }
  }

  const SubMesh& sub_mesh_;
  float cell_size_m_, tolerance_m_;
  std::span<std::uint32_t> parent_;
};

}  // namespace

void agree_on_sides(const SubMesh& sub_mesh, float cell_size_m, std::span<std::int8_t> sides,
                    std::span<std::uint32_t> surface, std::span<std::uint32_t> votes) {
  Surfaces surfaces(sub_mesh, cell_size_m, surface);
  const auto count = static_cast<std::uint32_t>(sides.size());
  for (std::uint32_t i = 0; i < count; ++i) {  // two of the four borders: the others are the neighbours' turn
    surfaces.join_beyond(i, 1, 0);
    surfaces.join_beyond(i, 0, 1);
    votes[i] = kBalance;
  }
  for (std::uint32_t i = 0; i < count; ++i)
    votes[surfaces.root(i)] += static_cast<std::uint32_t>(sub_mesh.layer(i).side);
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t vote = votes[surfaces.root(i)];
    sides[i] = vote == kBalance ? sub_mesh.layer(i).side : vote > kBalance ? std::int8_t{1} : std::int8_t{-1};
  }
}

}  // namespace lxd
