// SPDX-License-Identifier: Apache-2.0
#include "mapping/surface_map.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/nearest_layer.hpp"

namespace lxd {
namespace {

constexpr double kFillMax = 0.85;  // share of a sub-mesh's cells or layers in use at which the next one begins

MappingConfig coarse(MappingConfig config) {
  config.cell_size_m *= config.coarse_factor;
  config.kernel_length_m *= config.coarse_factor;
  return config;
}

template <std::size_t... I>
std::array<SubMesh, sizeof...(I)> make_sub_meshes(const MappingConfig& config, const SubMeshCapacity& capacity,
                                                  Arena& arena, std::index_sequence<I...>) {
  return {((void)I, SubMesh(config, capacity, arena))...};
}

}  // namespace

SurfaceMap::SurfaceMap(const MappingConfig& config, const SurfaceMapCapacity& capacity, Arena& arena)
    : config_(config),
      fine_(make_sub_meshes(config, capacity.fine, arena, std::make_index_sequence<kSubMeshCount>())),
      coarse_(make_sub_meshes(coarse(config), capacity.coarse, arena, std::make_index_sequence<kSubMeshCount>())) {}

void SurfaceMap::clear() {
  window_size_ = 0;
  retired_ = kNone;
  path_m_ = 0;
}

void SurfaceMap::insert(const MapSweep& sweep) noexcept {
  const Eigen::Vector3d sensor_world = sweep.origin_world_m + sweep.sensor_m.cast<double>();
  if (window_size_ > 0) path_m_ += (sensor_world - last_position_m_).norm();
  last_position_m_ = sensor_world;
  if (window_size_ == 0 || new_one_is_due()) begin_sub_mesh(sensor_world, sweep.stamp);
  const std::uint32_t youngest = order_[window_size_ - 1];
  fine_[youngest].insert(sweep.points, sweep.origin_world_m, sweep.sensor_m, sweep_);
  coarse_[youngest].insert(sweep.thinned_points, sweep.origin_world_m, sweep.sensor_m, sweep_);
  fine_[youngest].set_end(sweep.stamp);
  ++sweep_;
}

bool SurfaceMap::new_one_is_due() const {
  return path_m_ >= config_.submesh_path_m || window(window_size_ - 1).fill() >= kFillMax;
}

void SurfaceMap::begin_sub_mesh(const Eigen::Vector3d& near_world_m, RigTime stamp) {
  if (window_size_ == kSubMeshWindow) retire_oldest();
  const std::uint32_t next = order_[window_size_];
  fine_[next].reset(near_world_m, stamp);
  coarse_[next].reset(near_world_m, stamp);
  ++window_size_;
  path_m_ = 0;
}

// One that still waits may be read at this moment: it stays as it is, and the storage of this one is used again.
void SurfaceMap::retire_oldest() {
  if (retired_ == kNone) {
    retired_ = order_.front();
    std::rotate(order_.begin(), order_.begin() + 1, order_.end());
  } else {
    ++lost_;
    std::rotate(order_.begin(), order_.begin() + 1, order_.begin() + kSubMeshWindow);
  }
  --window_size_;
}

bool SurfaceMap::nearest(const Eigen::Vector3d& p_world_m, SurfaceHit& hit,
                         const Eigen::Vector3f& beam) const noexcept {
  return nearest_at(fine_, config_.cell_size_m, p_world_m, beam, hit) ||
         nearest_at(coarse_, config_.cell_size_m * config_.coarse_factor, p_world_m, beam, hit);
}

bool SurfaceMap::nearest_at(const std::array<SubMesh, kSubMeshCount>& level, double cell_size_m,
                            const Eigen::Vector3d& p_world_m, const Eigen::Vector3f& beam, SurfaceHit& hit) const {
  const CellIndex index = cell_of(p_world_m, 1.0 / cell_size_m);
  const Eigen::Vector3f p_cell = (p_world_m - index.cast<double>() * cell_size_m).cast<float>();
  const CellQuery query{index, p_cell, static_cast<float>(cell_size_m), static_cast<float>(kQuadsPerEdge / cell_size_m),
                        beam};
  const auto known = static_cast<float>(config_.mesh_sigma_max_m * config_.mesh_sigma_max_m);
  bool found = false;
  for (std::uint32_t i = 0; i < window_size_; ++i) {
    SurfaceHit candidate;
    if (!nearest_layer(level[order_[i]], query, candidate)) continue;
    if (found && candidate.variance_m2 >= hit.variance_m2) continue;
    hit = candidate;
    found = true;
    if (hit.variance_m2 < known) break;
  }
  return found;
}

}  // namespace lxd
