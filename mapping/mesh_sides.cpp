// SPDX-License-Identifier: Apache-2.0
#include "mapping/mesh_sides.hpp"

#include <cmath>
#include <utility>

namespace lxd {
namespace {

constexpr int kRounds = 6;            // a wrong patch shrinks by a cell from each side a round
constexpr float kSameSurface = 0.3f;  // spacings between two layers' heights at their border

// Mean height of the two middle vertices on the border towards (du, dv).
float border_height(const Layer& layer, int du, int dv) {
  constexpr int m = kVerticesPerEdge / 2, last = kVerticesPerEdge - 1;
  const auto at = [&](int u, int v) { return layer.height_m[v * kVerticesPerEdge + u]; };
  if (du != 0) return 0.5f * (at(du > 0 ? last : 0, m - 1) + at(du > 0 ? last : 0, m));
  return 0.5f * (at(m - 1, dv > 0 ? last : 0) + at(m, dv > 0 ? last : 0));
}

// Sum of the sides of the layers beyond the border towards (du, dv) that continue this one.
int votes_beyond(const SubMesh& sub_mesh, const Layer& layer, int du, int dv, float cell_size_m,
                 std::span<const std::int8_t> sides) {
  const float height = border_height(layer, du, dv), tolerance = kSameSurface * cell_size_m / kQuadsPerEdge;
  int sum = 0;
  for (int dw = -1; dw <= 1; ++dw) {
    CellIndex index = sub_mesh.cells()[layer.cell].index;
    index[axis_u(layer.axis)] += du;
    index[axis_v(layer.axis)] += dv;
    index[layer.axis] += dw;
    const std::uint32_t found = sub_mesh.find(index);
    if (found == kNone) continue;
    const Cell& cell = sub_mesh.cells()[found];
    for (std::uint32_t k = 0; k < cell.layer_count; ++k) {
      const Layer& other = sub_mesh.layer(cell.layers[k]);
      if (other.axis != layer.axis || cell.layers[k] >= sides.size()) continue;
      const float other_height = border_height(other, -du, -dv) + static_cast<float>(dw) * cell_size_m;
      if (std::abs(other_height - height) < tolerance) sum += sides[cell.layers[k]];
    }
  }
  return sum;
}

}  // namespace

void agree_on_sides(const SubMesh& sub_mesh, float cell_size_m, std::span<std::int8_t> sides) {
  for (std::uint32_t i = 0; i < sides.size(); ++i) sides[i] = sub_mesh.layer(i).side;
  for (int round = 0; round < kRounds; ++round) {
    bool changed = false;
    for (std::uint32_t i = 0; i < sides.size(); ++i) {
      int votes = sides[i];
      for (const auto& [du, dv] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}})
        votes += votes_beyond(sub_mesh, sub_mesh.layer(i), du, dv, cell_size_m, sides);
      if (votes * sides[i] >= 0) continue;
      sides[i] = static_cast<std::int8_t>(-sides[i]);
      changed = true;
    }
    if (!changed) break;
  }
}

}  // namespace lxd
