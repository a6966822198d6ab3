// SPDX-License-Identifier: Apache-2.0
#include "mapping/ray_cast.hpp"

#include <cmath>

#include "mapping/mesh_quads.hpp"
#include "mapping/ray_layer.hpp"

namespace lxd {
namespace {

constexpr std::uint32_t kAllQuads = (1u << kLayerQuads) - 1;
constexpr double kSameAlong = 1.0;     // fine spacings along the ray within which two sub-meshes show one surface
constexpr double kCoarseAgrees = 0.5;  // coarse spacings across a coarse surface within which a fine one is the same

struct Crossing {
  LayerCrossing on_layer;
  double along_m = 0;
  bool found = false;
};

// One level of the map, fine or coarse.
class LevelCast {
 public:
  LevelCast(const Ray& ray, double cell_size_m, float known_m2)
      : ray_(ray), cell_size_m_(cell_size_m), known_m2_(known_m2) {}

  // Nearest seen surface, small holes closed; beside it the nearest surface that nobody saw at that place.
  Crossing hit, unseen;

  // Window: the sub-meshes from the oldest to the youngest, by number.
  template <typename Window>
  void run(const Window& window, std::uint32_t count, double range_m) {
    LatticeWalk blocks(ray_, cell_size_m_ * OccupancyFilter::kBlockEdge, 0, range_m);
    do {
      if (hit.found && blocks.entry_m() > hit.along_m) return;
      std::uint32_t occupied = 0;
      for (std::uint32_t i = 0; i < count; ++i)
        occupied |= static_cast<std::uint32_t>(window(i).occupancy().may_hold(blocks.index())) << i;
      if (occupied != 0) walk_cells(window, occupied, blocks.entry_m(), blocks.exit_m());
    } while (blocks.advance());
  }

 private:
  template <typename Window>
  void walk_cells(const Window& window, std::uint32_t occupied, double begin_m, double end_m) {
    LatticeWalk cells(ray_, cell_size_m_, begin_m, end_m);
    do {
      if (hit.found && cells.entry_m() > hit.along_m) return;
      for (std::uint32_t i = 0; occupied >> i != 0; ++i)
        if ((occupied >> i & 1u) != 0) test_cell(window(i), cells.index(), cells.entry_m());
    } while (cells.advance());
  }

  void test_cell(const SubMesh& sub_mesh, const CellIndex& index, double entry_m) {
    const std::uint32_t found = sub_mesh.find(index);
    if (found == kNone) return;
    const Cell& cell = sub_mesh.cells()[found];
    const Eigen::Vector3d entry = ray_.at(entry_m) - index.cast<double>() * cell_size_m_;
    const CellRay ray{entry.cast<float>(), ray_.direction.cast<float>(), static_cast<float>(cell_size_m_)};
    for (std::uint32_t k = 0; k < cell.layer_count; ++k) test_layer(sub_mesh, cell.layers[k], ray, entry_m);
  }

  void test_layer(const SubMesh& sub_mesh, std::uint32_t index, const CellRay& ray, double entry_m) {
    const Layer& layer = sub_mesh.layer(index);
    Crossing crossing;
    if (first_crossing(layer, ray, layer.seen_quads, crossing.on_layer)) {
      crossing.along_m = entry_m + crossing.on_layer.along_m;
      take(crossing, hit);
    }
    const std::uint32_t others = kAllQuads & ~layer.seen_quads;
    if (others == 0 || !first_crossing(layer, ray, others, crossing.on_layer)) return;
    if (!well_known(layer, crossing.on_layer.quad)) return;
    crossing.along_m = entry_m + crossing.on_layer.along_m;
    take(crossing, is_small_hole(sub_mesh, layer, crossing.on_layer.quad, ray.cell_size_m) ? hit : unseen);
  }

  [[nodiscard]] bool well_known(const Layer& layer, int quad) const {
    const float* const s = &layer.variance_m2[quad / kQuadsPerEdge * kVerticesPerEdge + quad % kQuadsPerEdge];
    return std::max({s[0], s[1], s[kVerticesPerEdge], s[kVerticesPerEdge + 1]}) < known_m2_;
  }

  // The nearer one; of two sub-meshes' views of one surface the oldest that is well known.
  void take(Crossing crossing, Crossing& best) const {
    if (crossing.along_m < 0 || crossing.along_m > ray_.range_m) return;
    crossing.found = true;
    const double apart_m = crossing.along_m - best.along_m;
    const bool same = best.found && best.on_layer.front == crossing.on_layer.front &&
                      std::abs(apart_m) < kSameAlong * cell_size_m_ / kQuadsPerEdge;
    const bool better =
        same ? best.on_layer.variance_m2 >= known_m2_ && crossing.on_layer.variance_m2 < best.on_layer.variance_m2
             : apart_m < 0;
    if (!best.found || better) best = crossing;
  }

  const Ray& ray_;
  double cell_size_m_;
  float known_m2_;
};

bool fine_knows(const SurfaceMap& map, const Eigen::Vector3d& p_world_m) {
  const CellIndex index = cell_of(p_world_m, 1.0 / map.config().cell_size_m);
  for (std::uint32_t i = 0; i < map.window_size(); ++i) {
    const std::uint32_t cell = map.window(i).find(index);
    if (cell != kNone && map.window(i).cells()[cell].layer_count > 0) return true;
  }
  return false;
}

// How far the crossing is from the coarse surface, across that surface; positive: behind it.
double behind(const Crossing& coarse, const Crossing& fine, const Ray& ray) {
  const double cosine = -coarse.on_layer.normal.cast<double>().dot(ray.direction);
  return (fine.along_m - coarse.along_m) * cosine;
}

bool deliver(const Crossing& crossing, bool seen, const Ray& ray, RayHit& hit) {
  if (!crossing.found) return false;
  hit = {ray.at(crossing.along_m),      crossing.along_m,        crossing.on_layer.normal,
         crossing.on_layer.variance_m2, crossing.on_layer.front, seen};
  return std::isfinite(hit.variance_m2);
}

}  // namespace

bool cast_ray(const SurfaceMap& map, const Ray& ray, RayHit& hit) noexcept {
  if (!is_castable(ray)) return false;
  const MappingConfig& config = map.config();
  const double coarse_size_m = config.cell_size_m * config.coarse_factor;
  const auto known_m2 = static_cast<float>(config.mesh_sigma_max_m * config.mesh_sigma_max_m);
  LevelCast fine(ray, config.cell_size_m, known_m2);
  fine.run([&](std::uint32_t i) -> const SubMesh& { return map.window(i); }, map.window_size(), ray.range_m);
  LevelCast coarse(ray, coarse_size_m, known_m2);
  coarse.run([&](std::uint32_t i) -> const SubMesh& { return map.coarse_window(i); }, map.window_size(),
             fine.hit.found ? fine.hit.along_m : ray.range_m);
  if (!coarse.hit.found) return deliver(fine.hit, true, ray, hit);
  const double tolerance_m = kCoarseAgrees * coarse_size_m / kQuadsPerEdge;
  if (fine.hit.found && behind(coarse.hit, fine.hit, ray) < tolerance_m) return deliver(fine.hit, true, ray, hit);
  if (fine.unseen.found && std::abs(behind(coarse.hit, fine.unseen, ray)) < tolerance_m)
    return deliver(fine.unseen, false, ray, hit);
  if (fine_knows(map, ray.at(coarse.hit.along_m))) return deliver(fine.hit, true, ray, hit);
  return deliver(coarse.hit, false, ray, hit);
}

}  // namespace lxd
