// SPDX-License-Identifier: Apache-2.0
// One local sub-mesh: hashed cells with up to three GP layers each (paper, "Hierarchical Scene Representation"). All
// storage is lent at construction and bounded; reset() is constant time. Real-time thread only while it is in the
// window.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "mapping/batches.hpp"
#include "mapping/cell_hash.hpp"
#include "mapping/config.hpp"
#include "mapping/gaussian_process.hpp"
#include "mapping/layer.hpp"
#include "mapping/map_point.hpp"
#include "mapping/occupancy_filter.hpp"
#include "mapping/plane_search.hpp"
#include "mapping/waiting_pool.hpp"
#include "rt/arena.hpp"
#include "rt/time.hpp"

namespace lxd {

struct Cell {
  CellIndex index;
  std::array<std::uint32_t, kLayersPerCell> layers;
  std::uint32_t waiting;     // index of a WaitingBlock, or kNone
  std::uint32_t batch_head;  // first of this sweep's points in the cell, or kNone; a list through next_
  std::uint32_t layer_count;
};

struct SubMeshCapacity {
  std::uint32_t cells, layers, waiting_blocks, points_per_sweep;
};

// What found no room or no surface since the last reset.
struct SubMeshCounters {
  std::uint64_t cells_full = 0;    // points lost because no cell was free, or beyond the lattice
  std::uint64_t layers_full = 0;   // surfaces lost because no layer was free
  std::uint64_t waiting_full = 0;  // points lost because no waiting block was free
  std::uint64_t regressions = 0;   // GP batches fused
};

class SubMesh {
 public:
  SubMesh(const MappingConfig& config, const SubMeshCapacity& capacity, Arena& arena);

  // Empties it and moves its origin to the lattice corner nearest to `near_world`; constant time.
  void reset(const Eigen::Vector3d& near_world_m, RigTime begin);

  // Fuses one sweep. positions are relative to origin_world; `sensor` likewise, where the LiDAR was at the sweep's end.
  void insert(std::span<const MapPoint> points, const Eigen::Vector3d& origin_world_m, const Eigen::Vector3f& sensor_m,
              std::uint32_t sweep) noexcept;

  // Index of the cell in cells(), or kNone. `index` is of the world lattice.
  [[nodiscard]] std::uint32_t find(const CellIndex& index) const { return hash_.find(pack(index)); }

  // Where surfaces may be, by blocks of cells.
  [[nodiscard]] const OccupancyFilter& occupancy() const { return occupancy_; }

  [[nodiscard]] std::span<const Cell> cells() const { return cells_.first(cell_count_); }
  [[nodiscard]] const Layer& layer(std::uint32_t index) const { return layers_[index]; }
  [[nodiscard]] std::uint32_t layer_count() const { return layer_count_; }
  [[nodiscard]] const SubMeshCounters& counters() const { return counters_; }
  [[nodiscard]] const CellIndex& origin() const { return origin_; }  // lattice corner: its frame's zero, world axes
  [[nodiscard]] RigTime begin() const { return begin_; }
  [[nodiscard]] RigTime end() const { return end_; }
  void set_end(RigTime end) { end_ = end; }
  // Largest share of cells or layers in use, 0..1.
  [[nodiscard]] double fill() const;

 private:
  struct Batches;

  std::uint32_t find_or_create(const CellIndex& index);
  void distribute(std::span<const MapPoint> points, const Eigen::Vector3d& origin_world_m);
  void fuse_cell(Cell& cell, std::span<const MapPoint> points, const Eigen::Vector3f& origin_cell_m,
                 const Eigen::Vector3f& sensor_m, std::uint32_t sweep);
  [[nodiscard]] bool is_resting(const Cell& cell, std::uint32_t sweep) const;
  [[nodiscard]] int fitting_layer(const Cell& cell, const Eigen::Vector3f& p_cell_m, float variance_m2) const;
  void fuse_layer(Layer& layer, const QuadBins& bins, const Eigen::Vector3f& sensor_cell_m);
  void wait(Cell& cell, const Eigen::Vector3f& p_cell_m, float variance_m2, const Eigen::Vector3f& sensor_cell_m,
            std::uint32_t sweep);
  static std::size_t waiting_slot(WaitingBlock& block, CellKey key);
  bool borrow_block(Cell& cell, std::uint32_t sweep);
  void try_new_layers(Cell& cell);
  static std::uint16_t remove_members(WaitingBlock& block, std::uint32_t members);
  bool birth(Cell& cell, const WaitingBlock& block, const PlaneCandidate& plane,
             std::span<const Eigen::Vector3f> points_cell_m);

  MappingConfig config_;
  float cell_size_, inverse_cell_size_, inverse_spacing_;
  GpKernel kernel_;

  std::span<Cell> cells_;
  std::span<Layer> layers_;
  WaitingPool waiting_;
  std::span<std::uint32_t> next_;     // of each point of the sweep: the next one in its cell
  std::span<std::uint32_t> touched_;  // cells of the sweep
  CellHash hash_;
  OccupancyFilter occupancy_;
  std::uint32_t cell_count_ = 0, layer_count_ = 0, touched_count_ = 0;
  SubMeshCounters counters_;
  CellIndex origin_ = CellIndex::Zero();
  RigTime begin_, end_;
};

}  // namespace lxd
