// SPDX-License-Identifier: Apache-2.0
// Houses seen from outside: facades with recessed windows and doors, flat and pitched roofs.
#pragma once

#include "tools/simulator/world/ground.hpp"
#include "tools/simulator/world/mesh_builder.hpp"

namespace lxd::sim {

struct House {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();
  Eigen::Vector2d half_m{8, 6};
  double yaw_rad = 0;
  double height_m = 9;  // of its walls above the highest ground at its corners
};

// Balconies stay within this of the facade.
inline constexpr double kBalcony_m = 1.1;

void add_house(MeshBuilder& mesh, Random& random, const Ground& ground, const House& house);

}  // namespace lxd::sim
