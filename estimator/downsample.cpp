// SPDX-License-Identifier: Apache-2.0
#include "estimator/downsample.hpp"

#include <algorithm>
#include <cmath>

#include "mapping/lattice.hpp"

namespace lxd {
namespace {

constexpr double kEdgeMin_m = 0.05;
constexpr double kStepMax = 1.5;  // change of the edge between sweeps, at most

}  // namespace

bool VoxelSet::insert(std::uint64_t key) {
  std::size_t i = static_cast<std::size_t>(scatter(key)) & mask_;
  for (; slots_[i].epoch == epoch_; i = (i + 1) & mask_)
    if (slots_[i].key == key) return false;
  if (std::size_t{count_} * 4 >= slots_.size() * 3) return false;
  slots_[i] = {key, epoch_};
  ++count_;
  return true;
}

double next_voxel_edge(double edge_m, std::uint32_t count, int wanted) {
  const double factor = std::sqrt(static_cast<double>(std::max(count, 1u)) / wanted);
  return std::clamp(edge_m * std::clamp(factor, 1.0 / kStepMax, kStepMax), kEdgeMin_m, kVoxelEdgeMax_m);
}

double wider_voxel_edge(double edge_m) { return std::min(edge_m * kStepMax, kVoxelEdgeMax_m); }

}  // namespace lxd
