// SPDX-License-Identifier: Apache-2.0
#include "backend/loops/surfel_grid.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lxd {
namespace {

constexpr int kBits = 21;
constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;
constexpr float kNormalsAgree = 0.7F;  // cosine

std::uint64_t pack(const Eigen::Vector3i& cell) {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) key = (key << kBits) | (static_cast<std::uint64_t>(cell[axis]) & kMask);
  return key;
}

}  // namespace

SurfelGrid::SurfelGrid(std::span<const Surfel> surfels, double reach_m)
    : inverse_cell_pm_(static_cast<float>(1 / (2 * reach_m))) {
  std::vector<std::uint64_t> keys(surfels.size());
  for (std::size_t i = 0; i < surfels.size(); ++i) keys[i] = pack(cell_of(surfels[i].position_m));
  std::vector<std::uint32_t> order(surfels.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return keys[a] != keys[b] ? keys[a] < keys[b] : a < b; });
  surfels_.reserve(surfels.size());
  for (const std::uint32_t i : order) {
    const auto at = static_cast<std::uint32_t>(surfels_.size());
    surfels_.push_back(surfels[i]);
    const auto [cell, is_new] = cells_.try_emplace(keys[i], Range{at, at});
    cell->second.end = at + 1;
  }
}

Eigen::Vector3i SurfelGrid::cell_of(const Eigen::Vector3f& p_m) const {
  return (p_m * inverse_cell_pm_).array().floor().cast<int>();
}

void SurfelGrid::search(const Eigen::Vector3i& cell, const Eigen::Vector3f& p_m, const Eigen::Vector3f& normal,
                        float& best2, const Surfel*& best) const {
  const auto found = cells_.find(pack(cell));
  if (found == cells_.end()) return;
  for (std::uint32_t i = found->second.begin; i < found->second.end; ++i) {
    const Surfel& s = surfels_[i];
    const float d2 = (s.position_m - p_m).squaredNorm();
    if (!(d2 < best2) || s.normal.dot(normal) < kNormalsAgree) continue;
    best2 = d2;
    best = &s;
  }
}

const Surfel* SurfelGrid::nearest(const Eigen::Vector3f& p_m, const Eigen::Vector3f& normal, float reach_m) const {
  const Eigen::Vector3i low = cell_of(p_m - Eigen::Vector3f::Constant(reach_m));
  const Eigen::Vector3i high = cell_of(p_m + Eigen::Vector3f::Constant(reach_m));
  float best2 = reach_m * reach_m;
  const Surfel* best = nullptr;
  for (int x = low.x(); x <= high.x(); ++x)
    for (int y = low.y(); y <= high.y(); ++y)
      for (int z = low.z(); z <= high.z(); ++z) search({x, y, z}, p_m, normal, best2, best);
  return best;
}

}  // namespace lxd
