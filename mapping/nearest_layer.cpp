// SPDX-License-Identifier: Apache-2.0
#include "mapping/nearest_layer.hpp"

#include <algorithm>

#include "mapping/surface_map.hpp"

namespace lxd {
namespace {

// A surface continued beyond its cell turns away by about this much: variance grows with the way squared.
constexpr float kContinuationSlope = 0.2f;
// Farther than this share of a cell from every layer, a point has no surface.
constexpr float kReachShare = 1.0f;
// A beam that meets the back of a layer under more than this sine of an angle has not met that layer.
constexpr float kBehindSine = 0.2f;

// How far p is outside of the cell's square in the layer's two lattice directions.
float overhang(const Layer& layer, const Eigen::Vector3f& p_cell_m, float cell_size_m) {
  const auto outside = [cell_size_m](float x) { return std::max({0.0f, -x, x - cell_size_m}); };
  const float u = outside(p_cell_m[axis_u(layer.axis)]), v = outside(p_cell_m[axis_v(layer.axis)]);
  return std::sqrt(u * u + v * v);
}

// The layer of `cell` that is nearest to p, if it is nearer than `best_m`.
bool nearest_in_cell(const SubMesh& sub_mesh, const Cell& cell, const Eigen::Vector3f& p_cell_m, const CellQuery& q,
                     float& best_m, SurfaceHit& hit) {
  bool found = false;
  for (std::uint32_t k = 0; k < cell.layer_count; ++k) {
    const Layer& layer = sub_mesh.layer(cell.layers[k]);
    const LayerDistance d = distance_to(layer, p_cell_m, q.inverse_spacing);
    const float way = overhang(layer, p_cell_m, q.cell_size_m);
    const float reach = std::abs(d.distance_m) + way;
    if (reach >= best_m || static_cast<float>(layer.side) * d.normal.dot(q.beam) > kBehindSine) continue;
    best_m = reach;
    const float turn = kContinuationSlope * way;
    hit = {d.distance_m, d.variance_m2 + turn * turn, d.normal};
    found = true;
  }
  return found;
}

}  // namespace

bool nearest_layer(const SubMesh& sub_mesh, const CellQuery& q, SurfaceHit& hit) noexcept {
  float best = kReachShare * q.cell_size_m;
  const std::uint32_t own = sub_mesh.find(q.index);
  if (own != kNone && nearest_in_cell(sub_mesh, sub_mesh.cells()[own], q.p_cell_m, q, best, hit)) return true;
  bool found = false;
  for (int axis = 0; axis < 3; ++axis) {
    const bool upper = q.p_cell_m[axis] > 0.5f * q.cell_size_m;
    CellIndex index = q.index;
    index[axis] += upper ? 1 : -1;
    const std::uint32_t neighbour = sub_mesh.find(index);
    if (neighbour == kNone) continue;
    Eigen::Vector3f p = q.p_cell_m;
    p[axis] -= upper ? q.cell_size_m : -q.cell_size_m;
    found |= nearest_in_cell(sub_mesh, sub_mesh.cells()[neighbour], p, q, best, hit);
  }
  return found;
}

}  // namespace lxd
