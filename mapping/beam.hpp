// SPDX-License-Identifier: Apache-2.0
// The way of a return, from the LiDAR to what it fell on.
#pragma once

#include <functional>
#include <span>

#include <Eigen/Core>

namespace lxd {

struct Beam {
  Eigen::Vector3d from_m, to_m;  // world
};

// The next of many, some at a time; none: that was all.
using NextBeams = std::function<std::span<const Beam>()>;
inline std::span<const Beam> no_beams() { return {}; }

}  // namespace lxd
