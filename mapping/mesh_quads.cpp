// SPDX-License-Identifier: Apache-2.0
#include "mapping/mesh_quads.hpp"

#include <cmath>

namespace lxd {
namespace {

constexpr int kSeenNeighboursMin = 2;   // of four, that make an unseen quad a small hole
constexpr float kBeyondCellMax = 0.5f;  // spacings that an unseen quad's centre may be above or below its cell

bool seen(const Layer& layer, int iu, int iv) { return (layer.seen_quads >> (iv * kQuadsPerEdge + iu) & 1u) != 0; }

float centre_height(const Layer& layer, int iu, int iv) {
  const auto* h = &layer.height_m[iv * kVerticesPerEdge + iu];
  return 0.25f * (h[0] + h[1] + h[kVerticesPerEdge] + h[kVerticesPerEdge + 1]);
}

// Has the cell next to this one seen the quad (iu, iv) of the same surface? The quad is counted in that cell.
bool seen_next_door(const SubMesh& sub_mesh, const CellIndex& index, const Layer& layer, int iu, int iv, float height_m,
                    float tolerance_m) {
  const std::uint32_t cell = sub_mesh.find(index);
  if (cell == kNone) return false;
  const Cell& next = sub_mesh.cells()[cell];
  for (std::uint32_t k = 0; k < next.layer_count; ++k) {
    const Layer& other = sub_mesh.layer(next.layers[k]);
    if (other.axis == layer.axis && seen(other, iu, iv) &&
        std::abs(centre_height(other, iu, iv) - height_m) < tolerance_m)
      return true;
  }
  return false;
}

bool neighbour_seen(const SubMesh& sub_mesh, const Layer& layer, int iu, int iv, float height_m, float spacing_m) {
  constexpr int last = kQuadsPerEdge - 1;
  const int du = iu < 0 ? -1 : iu > last ? 1 : 0, dv = iv < 0 ? -1 : iv > last ? 1 : 0;
  if (du == 0 && dv == 0) return seen(layer, iu, iv);
  CellIndex index = sub_mesh.cells()[layer.cell].index;
  index[axis_u(layer.axis)] += du;
  index[axis_v(layer.axis)] += dv;
  return seen_next_door(sub_mesh, index, layer, iu - du * kQuadsPerEdge, iv - dv * kQuadsPerEdge, height_m, spacing_m);
}

// Of the four neighbours of a quad: seen ones to its left and right, and below and above it.
struct SeenNeighbours {
  int along_u = 0, along_v = 0;
};

SeenNeighbours seen_neighbours(const SubMesh& sub_mesh, const Layer& layer, int quad, float cell_size_m) {
  const int iu = quad % kQuadsPerEdge, iv = quad / kQuadsPerEdge;
  const float spacing = cell_size_m / kQuadsPerEdge, height = centre_height(layer, iu, iv);
  if (height < -kBeyondCellMax * spacing || height > cell_size_m + kBeyondCellMax * spacing) return {};
  const auto next_seen = [&](int du, int dv) {
    return static_cast<int>(neighbour_seen(sub_mesh, layer, iu + du, iv + dv, height, spacing));
  };
  return {next_seen(-1, 0) + next_seen(1, 0), next_seen(0, -1) + next_seen(0, 1)};
}

}  // namespace

bool is_small_hole(const SubMesh& sub_mesh, const Layer& layer, int quad, float cell_size_m) {
  const SeenNeighbours seen = seen_neighbours(sub_mesh, layer, quad, cell_size_m);
  return seen.along_u + seen.along_v >= kSeenNeighboursMin;
}

bool is_notch(const SubMesh& sub_mesh, const Layer& layer, int quad, float cell_size_m) {
  const SeenNeighbours seen = seen_neighbours(sub_mesh, layer, quad, cell_size_m);
  return seen.along_u == 1 && seen.along_v == 1;
}

std::uint32_t exported_quads(const SubMesh& sub_mesh, std::uint32_t index, float cell_size_m) {
  const Layer& layer = sub_mesh.layer(index);
  std::uint32_t quads = layer.seen_quads;
  for (int q = 0; q < kLayerQuads; ++q) {
    if ((layer.seen_quads >> q & 1u) != 0) continue;
    if (is_small_hole(sub_mesh, layer, q, cell_size_m)) quads |= 1u << q;
  }
  return quads;
}

}  // namespace lxd
