// SPDX-License-Identifier: Apache-2.0
// The vertices of one tile and its halo by place: cubes as wide as one looks, sorted, so that what is near lies in nine
// rows of memory.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "backend/seams/seam_scale.hpp"
#include "backend/seams/seam_vertex.hpp"

namespace lxd {

class TileGrid {
 public:
  explicit TileGrid(const SeamScale& scale);

  void build(std::span<const SeamVertex> vertices);

  // visit(i) for all vertices within reach about a place of the tile, or of its halo, and for others: the distance
  // tells.
  template <typename Visit>
  void for_each_near(const Eigen::Vector3f& p_m, Visit&& visit) const {
    const Cube middle = cube_of(p_m);
    const int last = cubes_ - 1;
    for (int x = std::max(middle[0] - 1, 0); x <= std::min(middle[0] + 1, last); ++x)
      for (int y = std::max(middle[1] - 1, 0); y <= std::min(middle[1] + 1, last); ++y) {
        const std::size_t low = index_of({x, y, std::max(middle[2] - 1, 0)});
        const std::size_t high = index_of({x, y, std::min(middle[2] + 1, last)});
        for (std::uint32_t i = begins_[low]; i < begins_[high + 1]; ++i)
          if ((entries_[i].position_m - p_m).squaredNorm() < reach_m_ * reach_m_) visit(entries_[i].vertex);
      }
  }

 private:
  using Cube = std::array<int, 3>;
  struct Entry {
    Eigen::Vector3f position_m;
    std::uint32_t vertex;
  };

  [[nodiscard]] Cube cube_of(const Eigen::Vector3f& p_m) const {
    const auto along = [&](float x_m) {
      return std::clamp(static_cast<int>((x_m + margin_m_) / reach_m_), 0, cubes_ - 1);
    };
    return {along(p_m.x()), along(p_m.y()), along(p_m.z())};
  }
  [[nodiscard]] std::size_t index_of(const Cube& cube) const {
    return static_cast<std::size_t>((cube[0] * cubes_ + cube[1]) * cubes_ + cube[2]);
  }

  float reach_m_, margin_m_;
  int cubes_;  // along each edge
  std::vector<std::uint32_t> begins_;
  std::vector<Entry> entries_;
};

}  // namespace lxd
