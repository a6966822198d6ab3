// SPDX-License-Identifier: Apache-2.0
// Surface elements by place, for the nearest one to a point.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include "backend/loops/surfels.hpp"

namespace lxd {

class SurfelGrid {
 public:
  // Answers reach as far as half a cell. The surfels are copied, in order of cell.
  SurfelGrid(std::span<const Surfel> surfels, double reach_m);

  // The surfel nearest to `p_m` within reach whose normal is within about 45 degrees of `normal`; nullptr: none.
  [[nodiscard]] const Surfel* nearest(const Eigen::Vector3f& p_m, const Eigen::Vector3f& normal, float reach_m) const;

  [[nodiscard]] std::span<const Surfel> surfels() const { return surfels_; }

 private:
  struct Range {
    std::uint32_t begin, end;
  };
  [[nodiscard]] Eigen::Vector3i cell_of(const Eigen::Vector3f& p_m) const;
  void search(const Eigen::Vector3i& cell, const Eigen::Vector3f& p_m, const Eigen::Vector3f& normal, float& best2,
              const Surfel*& best) const;

  float inverse_cell_pm_;
  std::vector<Surfel> surfels_;
  std::unordered_map<std::uint64_t, Range> cells_;
};

}  // namespace lxd
