// SPDX-License-Identifier: Apache-2.0
// A pose with its time: the element of every path that is stored, written, drawn or evaluated.
#pragma once

#include "rt/pose.hpp"
#include "rt/time.hpp"

namespace lxd {

struct StampedPose {
  RigTime stamp;
  Pose T;  // T_map_reference, m
};

}  // namespace lxd
