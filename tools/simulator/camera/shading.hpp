// SPDX-License-Identifier: Apache-2.0
// What a ray sees: linear RGB radiance, in which a white surface in full light is 1. One sun without shadows, light
// from all around that is brighter from above, a sky; the same outdoors and indoors.
#pragma once

#include <Eigen/Core>

#include "tools/simulator/world/scene.hpp"

namespace lxd::sim {

[[nodiscard]] Eigen::Array3f radiance(const World& world, const Hit& hit, const Eigen::Vector3f& direction);

// Rec. 709's weights.
[[nodiscard]] inline float luminance(const Eigen::Array3f& rgb) {
  return 0.2126F * rgb.x() + 0.7152F * rgb.y() + 0.0722F * rgb.z();
}

}  // namespace lxd::sim
