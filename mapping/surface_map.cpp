// SPDX-License-Identifier: Apache-2.0
#include "mapping/surface_map.hpp"

#include <cmath>

#include "mapping/nearest_layer.hpp"

namespace lxd {
namespace {

constexpr double kFillMax = 0.85;  // share of a sub-mesh's cells or layers in use at which the next one begins

template <std::size_t... I>
std::array<SubMesh, sizeof...(I)> make_sub_meshes(const MappingConfig& config, const SubMeshCapacity& capacity, Arena& arena,
                                                  std::index_sequence<I...>) {
  return {((void)I, SubMesh(config, capacity, arena))...};
}

}  // namespace

SurfaceMap::SurfaceMap(const MappingConfig& config, const SubMeshCapacity& capacity, Arena& arena)
    : config_(config),
      inverse_cell_size_(1.0 / config.cell_size_m),
      inverse_spacing_(static_cast<float>(kQuadsPerEdge / config.cell_size_m)),
      sub_meshes_(make_sub_meshes(config, capacity, arena, std::make_index_sequence<kSubMeshCount>())) {}

void SurfaceMap::clear() {
  oldest_ = window_size_ = 0;
  retired_ = kNone;
  path_m_ = 0;
}

void SurfaceMap::insert(std::span<const MapPoint> points, const Eigen::Vector3d& origin_world_m, const Eigen::Vector3f& sensor_m,
                        RigTime stamp) noexcept {
  const Eigen::Vector3d sensor_world = origin_world_m + sensor_m.cast<double>();
  if (window_size_ > 0) path_m_ += (sensor_world - last_position_m_).norm();
  last_position_m_ = sensor_world;
  if (window_size_ == 0 || new_one_is_due()) begin_sub_mesh(sensor_world, stamp);
  SubMesh& youngest = sub_meshes_[slot(window_size_ - 1)];
  youngest.insert(points, origin_world_m, sensor_m, sweep_++);
  youngest.set_end(stamp);
}

bool SurfaceMap::new_one_is_due() const {
  return path_m_ >= config_.submesh_path_m || window(window_size_ - 1).fill() >= kFillMax;
}

void SurfaceMap::begin_sub_mesh(const Eigen::Vector3d& near_world_m, RigTime stamp) {
  if (window_size_ == kSubMeshWindow) {
    if (retired_ != kNone) ++lost_;
    retired_ = slot(0);
    oldest_ = slot(1);
    --window_size_;
  }
  sub_meshes_[slot(window_size_)].reset(near_world_m, stamp);
  ++window_size_;
  ++begun_;
  path_m_ = 0;
}

bool SurfaceMap::nearest(const Eigen::Vector3d& p_world_m, SurfaceHit& hit) const noexcept {
  const CellIndex index = cell_of(p_world_m, inverse_cell_size_);
  const Eigen::Vector3f p_cell =
      (p_world_m - index.cast<double>() * config_.cell_size_m).cast<float>();
  const CellQuery query{index, p_cell, static_cast<float>(config_.cell_size_m), inverse_spacing_};
  const auto known = static_cast<float>(config_.mesh_sigma_max_m * config_.mesh_sigma_max_m);
  bool found = false;
  for (std::uint32_t i = 0; i < window_size_; ++i) {
    SurfaceHit candidate;
    if (!nearest_layer(window(i), query, candidate)) continue;
    if (found && candidate.variance_m2 >= hit.variance_m2) continue;
    hit = candidate;
    found = true;
    if (hit.variance_m2 < known) break;
  }
  return found;
}

}  // namespace lxd
