// SPDX-License-Identifier: Apache-2.0
#include "backend/seams/tile_grid.hpp"

#include <cmath>
#include <numeric>

namespace lxd {

TileGrid::TileGrid(const SeamScale& scale)
    : reach_m_(scale.reach_m()),
      margin_m_(scale.halo_m()),
      cubes_(static_cast<int>(std::ceil((scale.tile_m() + 2 * margin_m_) / reach_m_))) {}

// A counting sort: vertices of a cube keep their order.
void TileGrid::build(std::span<const SeamVertex> vertices) {
  const Cube last{cubes_ - 1, cubes_ - 1, cubes_ - 1};
  begins_.assign(index_of(last) + 2, 0);
  for (const SeamVertex& v : vertices) ++begins_[index_of(cube_of(v.position_m)) + 1];
  std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
  entries_.resize(vertices.size());
  for (std::size_t i = vertices.size(); i-- > 0;)
    entries_[--begins_[index_of(cube_of(vertices[i].position_m)) + 1]] = {vertices[i].position_m,
                                                                          static_cast<std::uint32_t>(i)};
  begins_.erase(begins_.begin());
  begins_.push_back(static_cast<std::uint32_t>(vertices.size()));
}

}  // namespace lxd
