// SPDX-License-Identifier: Apache-2.0
#include "mapping/mesh_extraction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <new>

#include "mapping/free_space.hpp"
#include "mapping/mesh_quads.hpp"
#include "mapping/mesh_sides.hpp"
#include "mapping/mesh_trim.hpp"

namespace lxd {
namespace {

// Vertices of neighbouring layers on one lattice line are one when their heights agree within
// kFuseSigmas * sigma + kFuseShare * spacing, never farther apart than kFuseMaxShare * spacing.
constexpr float kFuseSigmas = 3.0f;
constexpr float kFuseShare = 0.3f;
constexpr float kFuseMaxShare = 0.75f;

// Smaller connected parts are vegetation and noise: half of a cell's quads.
constexpr std::uint8_t kPartFacesMin = 25;

// The running inverse-variance mean of the corners that make one vertex.
struct Fusion {
  float weight = 0, weighted_height_m = 0;

  void add(float height_m, float variance_m2) {
    weight += 1.0f / variance_m2;
    weighted_height_m += height_m / variance_m2;
  }
  [[nodiscard]] float height_m() const { return weighted_height_m / weight; }
  [[nodiscard]] float variance_m2() const { return 1.0f / weight; }
  [[nodiscard]] bool takes(float height_m_, float variance_m2_, float spacing_m) const {
    if (weight == 0) return true;
    const float gate = kFuseSigmas * std::sqrt(variance_m2_ + variance_m2()) + kFuseShare * spacing_m;
    return std::abs(height_m_ - height_m()) <= std::min(gate, kFuseMaxShare * spacing_m);
  }
};

// Corners of quad q among the layer's vertices, counter-clockwise seen from +axis.
constexpr std::array<int, 4> corners_of(int q) {
  const int i = q / kQuadsPerEdge * kVerticesPerEdge + q % kQuadsPerEdge;
  return {i, i + 1, i + kVerticesPerEdge + 1, i + kVerticesPerEdge};
}

// Bits of the layer's vertices that the quads use.
std::uint64_t used_vertices(std::uint32_t quads) {
  std::uint64_t used = 0;
  for (int q = 0; q < kLayerQuads; ++q)
    if (quads >> q & 1u)
      for (const int i : corners_of(q)) used |= std::uint64_t{1} << i;
  return used;
}

// Objects begin where those of an earlier step end.
template <typename T>
std::span<T> begin_as(std::span<std::byte> storage, std::size_t count) {
  T* const first = reinterpret_cast<T*>(storage.data());
  std::uninitialized_default_construct_n(first, count);
  return {std::launder(first), count};
}

int shared(const std::array<std::uint32_t, 4>& a, const std::array<std::uint32_t, 4>& b) {
  int count = 0;
  for (const std::uint32_t x : a) count += std::find(b.begin(), b.end(), x) != b.end();
  return count;
}

}  // namespace

MeshExtraction::MeshExtraction(const MappingConfig& config, const MeshCapacity& capacity, Arena& arena)
    : cell_size_m_(static_cast<float>(config.cell_size_m)),
      spacing_m_(cell_size_m_ / kQuadsPerEdge),
      variance_max_m2_(static_cast<float>(config.mesh_sigma_max_m * config.mesh_sigma_max_m)),
      entries_(arena.take<LatticeEntry>("mesh lattice entries", capacity.corners)),
      vertex_of_(arena.take<std::uint32_t>("mesh layer vertices", std::size_t{capacity.layers} * kLayerVertices)),
      quads_(arena.take<std::uint32_t>("mesh layer quads", capacity.layers)),
      sides_(arena.take<std::int8_t>("mesh layer sides", capacity.layers)),
      beam_counts_(std::size_t{capacity.layers} * kBeamCounts),
      boundary_entries_(capacity.boundary),
      lent_(arena.take<std::byte>("mesh beams, then boundary", std::max(beam_counts_ * sizeof(std::uint32_t),
                                                                        boundary_entries_ * sizeof(BoundaryEntry)))),
      topology_(capacity.vertices, capacity.faces, arena) {}

MeshExtraction::Mesh MeshExtraction::extract(const SubMesh& sub_mesh, BeamSource& beams) noexcept {
  counters_ = {};
  topology_.clear();
  choose_quads(sub_mesh, beams);
  for (int axis = 0; axis < 3; ++axis) {
    collect_corners(sub_mesh, axis);
    fuse_corners(sub_mesh, axis);
    collect_quads(sub_mesh, axis);
    emit_quads();
    trim_quads(sub_mesh);
  }
  topology_.update_normals();
  topology_.project_variances();
  counters_.seam_lost = MeshSeam(topology_, spacing_m_, begin_as<BoundaryEntry>(lent_, boundary_entries_)).close();
  topology_.update_normals();
  topology_.compact(kPartFacesMin);
  return {topology_.vertices(), topology_.faces()};
}

void MeshExtraction::choose_quads(const SubMesh& sub_mesh, BeamSource& beams) {
  layer_count_ = std::min<std::uint32_t>(sub_mesh.layer_count(), static_cast<std::uint32_t>(quads_.size()));
  counters_.layers_lost = sub_mesh.layer_count() - layer_count_;
  agree_on_sides(sub_mesh, cell_size_m_, sides_.first(layer_count_), quads_.first(layer_count_),
                 vertex_of_.first(layer_count_));  // both are filled later
  for (std::uint32_t i = 0; i < layer_count_; ++i) quads_[i] = exported_quads(sub_mesh, i, cell_size_m_);
  beams_ = begin_as<std::uint32_t>(lent_, beam_counts_);
  judge_by_beams(sub_mesh, beams, cell_size_m_, {quads_.first(layer_count_), sides_.first(layer_count_), beams_},
                 vertex_of_);
}

void MeshExtraction::add_entry(std::uint64_t key, float order, std::uint32_t slot) {
  if (entry_count_ == entries_.size()) {
    ++counters_.corners_lost;
    return;
  }
  entries_[entry_count_++] = {key, order, slot};
}

void MeshExtraction::collect_corners(const SubMesh& sub_mesh, int axis) {
  entry_count_ = 0;
  for (std::uint32_t l = 0; l < layer_count_; ++l) {
    const Layer& layer = sub_mesh.layer(l);
    if (layer.axis != axis) continue;
    const CellIndex cell = sub_mesh.cells()[layer.cell].index - sub_mesh.origin();
    const std::uint64_t used = used_vertices(quads_[l]);
    for (int i = 0; i < kLayerVertices; ++i) {
      vertex_of_[l * kLayerVertices + i] = kNone;
      if ((used >> i & 1u) == 0) continue;
      const CellIndex line(cell[axis_u(axis)] * kQuadsPerEdge + i % kVerticesPerEdge,
                           cell[axis_v(axis)] * kQuadsPerEdge + i / kVerticesPerEdge, sides_[l]);
      const float height = static_cast<float>(cell[axis]) * cell_size_m_ + layer.height_m[i];
      add_entry(pack(line), height, l * kLayerVertices + i);
    }
  }
}

// Runs of corners on one lattice line that agree become one vertex.
void MeshExtraction::fuse_corners(const SubMesh& sub_mesh, int axis) {
  const auto corners = entries_.first(entry_count_);
  std::sort(corners.begin(), corners.end());
  for (std::size_t begin = 0; begin < corners.size();) {
    Fusion fusion;
    std::size_t end = begin;
    for (; end < corners.size() && corners[end].key == corners[begin].key; ++end) {
      const std::uint32_t slot = corners[end].slot;
      const float variance = sub_mesh.layer(slot / kLayerVertices).variance_m2[slot % kLayerVertices];
      if (!fusion.takes(corners[end].order, variance, spacing_m_)) break;
      fusion.add(corners[end].order, variance);
    }
    const CellIndex line = unpack(corners[begin].key);
    Eigen::Vector3f position;
    position[axis_u(axis)] = static_cast<float>(line[0]) * spacing_m_;
    position[axis_v(axis)] = static_cast<float>(line[1]) * spacing_m_;
    position[axis] = fusion.height_m();
    const std::uint32_t vertex = topology_.add_vertex(position, fusion.variance_m2(), static_cast<AxisMask>(1 << axis));
    counters_.vertices_lost += vertex == kNone;
    for (; begin < end; ++begin) vertex_of_[corners[begin].slot] = vertex;
  }
}

std::array<std::uint32_t, 4> MeshExtraction::quad_vertices(std::uint32_t layer, int quad) const {
  std::array<std::uint32_t, 4> out{};
  const auto corners = corners_of(quad);
  for (int k = 0; k < 4; ++k) out[k] = vertex_of_[layer * kLayerVertices + corners[k]];
  return out;
}

void MeshExtraction::collect_quads(const SubMesh& sub_mesh, int axis) {
  entry_count_ = 0;
  for (std::uint32_t l = 0; l < layer_count_; ++l) {
    const Layer& layer = sub_mesh.layer(l);
    if (layer.axis != axis) continue;
    const CellIndex cell = sub_mesh.cells()[layer.cell].index - sub_mesh.origin();
    for (int q = 0; q < kLayerQuads; ++q) {
      if ((quads_[l] >> q & 1u) == 0) continue;
      const auto vertices = quad_vertices(l, q);
      if (std::find(vertices.begin(), vertices.end(), kNone) != vertices.end()) continue;
      float worst = 0;
      for (const std::uint32_t v : vertices) worst = std::max(worst, topology_.vertex(v).variance_m2);
      if (worst > variance_max_m2_) continue;
      const bool seen = layer.seen_quads >> q & 1u;
      const CellIndex square(cell[axis_u(axis)] * kQuadsPerEdge + q % kQuadsPerEdge,
                             cell[axis_v(axis)] * kQuadsPerEdge + q / kQuadsPerEdge, sides_[l]);
      add_entry(pack(square), seen ? worst : worst + variance_max_m2_, l * kLayerVertices + q);
    }
  }
}

// Of quads on one lattice square that share an edge or more, only the best known one stays: these are the entries left.
void MeshExtraction::emit_quads() {
  const auto quads = entries_.first(entry_count_);
  std::sort(quads.begin(), quads.end());
  entry_count_ = 0;
  constexpr std::size_t kStackMax = 8;  // sheets above each other on one square that are compared
  std::array<std::array<std::uint32_t, 4>, kStackMax> stack;
  std::size_t height = 0;
  std::uint64_t key = ~std::uint64_t{0};
  for (const LatticeEntry& entry : quads) {
    if (entry.key != key) height = 0;
    key = entry.key;
    const std::uint32_t layer = entry.slot / kLayerVertices;
    const auto quad = quad_vertices(layer, static_cast<int>(entry.slot % kLayerVertices));
    const auto accepted = std::span(stack).first(height);
    if (height == kStackMax ||
        std::any_of(accepted.begin(), accepted.end(), [&](const auto& q) { return shared(q, quad) >= 2; }))
      continue;
    stack[height++] = quad;
    emit_quad(quad, sides_[layer]);
    entries_[entry_count_++] = entry;
  }
}

std::array<float, 4> MeshExtraction::overhang_of(const SubMesh& sub_mesh, std::uint32_t index, int quad) const {
  const auto beams = beams_.subspan(index * kBeamCounts, kLayerQuads);
  const Layer& layer = sub_mesh.layer(index);
  if ((layer.seen_quads >> quad & 1u) != 0 || !is_notch(sub_mesh, layer, quad, cell_size_m_))
    return QuadBeams::of(beams[static_cast<std::size_t>(quad)]).overhang();
  return overhang_of_notch(beams, layer.seen_quads);
}

void MeshExtraction::trim_quads(const SubMesh& sub_mesh) {
  MeshTrim trim(topology_, entries_.subspan(entry_count_));
  for (const LatticeEntry& entry : entries_.first(entry_count_)) {
    const std::uint32_t layer = entry.slot / kLayerVertices, quad = entry.slot % kLayerVertices;
    trim.add(quad_vertices(layer, static_cast<int>(quad)), overhang_of(sub_mesh, layer, static_cast<int>(quad)));
  }
  counters_.trims_lost += trim.apply();
}

// Two triangles, cut along the shorter diagonal.
void MeshExtraction::emit_quad(const std::array<std::uint32_t, 4>& quad, int side) {
  auto [a, b, c, d] = quad;
  if (side < 0) std::swap(b, d);
  const auto distance = [&](std::uint32_t i, std::uint32_t k) {
    return (topology_.vertex(i).position_m - topology_.vertex(k).position_m).squaredNorm();
  };
  if (distance(a, c) <= distance(b, d)) {
    add_face(a, b, c);
    add_face(a, c, d);
  } else {
    add_face(a, b, d);
    add_face(b, c, d);
  }
}

void MeshExtraction::add_face(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  counters_.faces_lost += topology_.add_face(a, b, c) == MeshTopology::Added::no_room;
}

}  // namespace lxd
