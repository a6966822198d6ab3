// SPDX-License-Identifier: Apache-2.0
// The exact motion of the carrier through the hall: at rest, then blended into a smooth path of all six degrees of
// freedom.
#pragma once

#include "rt/pose.hpp"

namespace lxd::boxroom {

class Motion {
 public:
  // angular_speed: how many times faster than the standard motion the carrier turns, on the same path.
  Motion(double rest_s, double angular_speed) : rest_s_(rest_s), angular_speed_(angular_speed) {}

  // World: z up, floor at z = 0. Body: the IMU. t_s: seconds since the first sweep's first firing, negative allowed.
  [[nodiscard]] Pose world_body(double t_s) const;

 private:
  [[nodiscard]] double path_time_s(double t_s) const;

  double rest_s_;
  double angular_speed_;
};

}  // namespace lxd::boxroom
