// SPDX-License-Identifier: Apache-2.0
// Thins a sweep by space, never by point index: one return a voxel. The voxel's edge follows the scene, so that a
// closet and a street both give about the wanted number of points.
#pragma once

#include <cstdint>
#include <span>

#include "rt/arena.hpp"

namespace lxd {

// Set of voxels already taken; constant-time clear by epoch.
class VoxelSet {
 public:
  struct Slot {
    std::uint64_t key = 0;
    std::uint32_t epoch = 0;
  };
  explicit VoxelSet(std::span<Slot> slots) : slots_(slots), mask_(slots.size() - 1) {}

  void clear() {
    ++epoch_;
    count_ = 0;
  }
  // True when the voxel was free; false when it was taken or the set is three quarters full.
  bool insert(std::uint64_t key);
  [[nodiscard]] std::uint32_t count() const { return count_; }

 private:
  std::span<Slot> slots_;
  std::size_t mask_;
  std::uint32_t epoch_ = 1, count_ = 0;
};

// Edge of the voxels for the next sweep, when `edge_m` gave `count` points and `wanted` were wanted. Points lie on
// surfaces: their number goes with the inverse square of the edge.
double next_voxel_edge(double edge_m, std::uint32_t count, int wanted);

inline constexpr double kVoxelEdgeMax_m = 3.0;  // farther apart, points no longer hold a room

// Edge to thin the same sweep with again when more voxels were taken than there is room for.
double wider_voxel_edge(double edge_m);

}  // namespace lxd
