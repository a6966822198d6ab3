// SPDX-License-Identifier: Apache-2.0
// What a sweep tells of the other sensors' clocks and mounts.
#include "estimator/odometry.hpp"

namespace lxd {

// In the middle of a sweep the pose hangs least on how the rates are believed.
void Odometry::align_sensors() {
  const RigTime middle = begin_ + (end_ - begin_) / 2;
  if (outcome_.tracked && outcome_.points_used >= kResidualsMin && outcome_.degenerate_directions == 0)
    motion_.align_sensors(filter_.state(), middle, pose_at(middle));
  else
    motion_.forget_path();
}

}  // namespace lxd
