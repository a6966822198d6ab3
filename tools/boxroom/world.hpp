// SPDX-License-Identifier: Apache-2.0
// The exact world: a closed hall with boxes on its floor, and the distance to it along a ray.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "tools/boxroom/motion.hpp"
#include "tools/boxroom/noise.hpp"

namespace lxd::boxroom {

struct Box {
  Eigen::Vector3d low_m, high_m;  // world frame
};

class World {
 public:
  // Draws the boxes; none comes near the path of `motion`.
  World(Noise& noise, const Motion& motion);

  // Metres from origin_m along the unit vector `direction` (both world frame) to the first surface. The origin is
  // inside the hall; the inside of a box is not seen.
  [[nodiscard]] double range_m(const Eigen::Vector3d& origin_m, const Eigen::Vector3d& direction) const;

  [[nodiscard]] const Box& hall() const { return hall_; }
  [[nodiscard]] const std::vector<Box>& boxes() const { return boxes_; }

 private:
  Box hall_;
  std::vector<Box> boxes_;
};

}  // namespace lxd::boxroom
