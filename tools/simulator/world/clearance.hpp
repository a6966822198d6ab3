// SPDX-License-Identifier: Apache-2.0
// Whether a motion stays in the world and out of its surfaces.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>

#include <Eigen/Core>

#include "tools/simulator/world/scene.hpp"

namespace lxd::sim {

struct ClearanceRules {
  double radius_m = 0.3;     // no surface nearer than this to either side and above
  double below_m = 0.05;     // no surface nearer than this below: the body may ride low
  double headroom_m = 50;    // how far above its highest surface a world ends
  bool needs_ground = true;  // something below every position; a scanned world may have holes
  double sample_m = 0.1;     // positions closer than this to the last one that was looked at are skipped
};

struct Collision {
  std::size_t index;  // of the path: the position that cannot be, or is not reached from the one before it
  std::string what;   // "is 0.12 m from wood"
};

// The first place where the path leaves the world (its bounding box), crosses a surface or passes too near to one.
// Movers do not count. A glass pane is a surface like any other.
[[nodiscard]] std::optional<Collision> first_collision(const Scene& scene, std::span<const Eigen::Vector3d> path_m,
                                                       const ClearanceRules& rules = {});

// The material of the first surface on the straight way, movers aside; nothing: the way is free.
[[nodiscard]] std::optional<std::string> surface_between(const Scene& scene, const Eigen::Vector3d& from_m,
                                                         const Eigen::Vector3d& to_m);

}  // namespace lxd::sim
