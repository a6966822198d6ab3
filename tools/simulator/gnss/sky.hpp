// SPDX-License-Identifier: Apache-2.0
// How much of the sky an antenna sees.
#pragma once

#include <vector>

#include "tools/simulator/world/scene.hpp"

namespace lxd::sim {

class Sky {
 public:
  // Directions that lie even on the sphere above the mask.
  explicit Sky(double mask_rad);

  // Part of the sky that surfaces hide, 0 .. 1. Glass hides nothing.
  [[nodiscard]] double blocked_part(const Scene& scene, const Eigen::Vector3d& antenna_m, double t_s) const;

 private:
  std::vector<Eigen::Vector3f> directions_;
};

}  // namespace lxd::sim
