// SPDX-License-Identifier: Apache-2.0
// T_map_world as others are told it: where the graph's leaps to, it goes within a second or so. What is smooth is the
// body's pose in the map, wherever in the world it is.
#pragma once

#include <algorithm>
#include <cmath>

#include "backend/graph/pose_blend.hpp"
#include "rt/key_frame.hpp"

namespace lxd {

class SmoothCorrection {
 public:
  explicit SmoothCorrection(double time_constant_s) : time_constant_s_(time_constant_s) {}

  // `target`: T_map_world by the graph now. Stamps must not decrease.
  const MapCorrection& step(RigTime stamp, const Pose& T_world_body, const Pose& target) {
    const double dt_s = begun_ ? std::max(0.0, (stamp - told_.stamp).seconds()) : 0.0;
    const double share = begun_ ? 1 - std::exp(-dt_s / time_constant_s_) : 1.0;
    told_.T_map_world = blend(told_.T_map_world * T_world_body, target * T_world_body, share) * T_world_body.inverse();
    told_.stamp = stamp;
    begun_ = true;
    return told_;
  }

 private:
  double time_constant_s_;
  MapCorrection told_;
  bool begun_ = false;
};

}  // namespace lxd
