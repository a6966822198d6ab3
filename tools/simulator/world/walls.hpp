// SPDX-License-Identifier: Apache-2.0
// Walls with doors and windows, floors with holes.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "tools/simulator/world/mesh_builder.hpp"

namespace lxd::sim {

// A hole through a wall, in the wall's own coordinates.
struct Opening {
  double from_m, to_m;  // along the wall
  double low_m, high_m;
  bool glazed = false;  // a pane in the middle of the wall, with a bar
};

struct Wall {
  Eigen::Vector2d from, to;
  double thickness_m = 0.2;
  double low_m = 0, high_m = 3;
  std::vector<Opening> openings;  // apart from each other, any order
};

void add_wall(MeshBuilder& mesh, Wall wall, Surface surface);

struct Rect {
  Eigen::Vector2d low, high;

  [[nodiscard]] Eigen::Vector2d middle() const { return (low + high) / 2; }
  [[nodiscard]] double width_m() const { return high.x() - low.x(); }
  [[nodiscard]] double depth_m() const { return high.y() - low.y(); }
};

// A slab from low_m to high_m, without what is above the hole.
void add_slab(MeshBuilder& mesh, const Rect& area, const Rect& hole, double low_m, double high_m, Surface surface);

}  // namespace lxd::sim
