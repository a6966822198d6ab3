// SPDX-License-Identifier: Apache-2.0
// What stands outdoors. Every placement's foot is on the ground; what must not float goes a little deeper.
#pragma once

#include "tools/simulator/world/ground.hpp"
#include "tools/simulator/world/mesh_builder.hpp"

namespace lxd::sim {

struct TreeSize {
  double trunk_m;         // height
  double trunk_radius_m;  // at the foot
  double crown_radius_m;
  double crown_half_m;  // half its height

  [[nodiscard]] double top_m() const { return trunk_m + 2 * crown_half_m; }
  static TreeSize random(Random& random, double scale);
};
void add_tree(MeshBuilder& mesh, Random& random, const Placement& at, const TreeSize& size);

void add_lamp_post(MeshBuilder& mesh, Random& random, const Placement& at);
inline constexpr double kLampPostHalf_m = 0.15;
inline constexpr double kLampPostHeight_m = 8.5;  // at most
void add_sign(MeshBuilder& mesh, Random& random, const Placement& at);

// Heading along the placement's x; at most 4.8 m x 1.9 m.
void add_parked_car(MeshBuilder& mesh, Random& random, const Placement& at);
inline constexpr double kCarHalfLength_m = 2.4;
inline constexpr double kCarHalfWidth_m = 0.95;

// Along the placement's x.
void add_hedge(MeshBuilder& mesh, Random& random, const Placement& at, double length_m, double width_m);
void add_wall(MeshBuilder& mesh, const Placement& at, double length_m, double height_m, Surface surface);
void add_bench(MeshBuilder& mesh, const Placement& at);

// A raised edge along the line, following the ground.
void add_kerb(MeshBuilder& mesh, const Ground& ground, const Line& line, bool closed, double width_m, double height_m,
              Surface surface);

}  // namespace lxd::sim
