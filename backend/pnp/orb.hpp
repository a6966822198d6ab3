// SPDX-License-Identifier: Apache-2.0
// ORB descriptors at given pixels: of mature features only, which the front-end has found and followed already.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "backend/pnp/visual_key_frame.hpp"

namespace lxd {

// An 8-bit grey image, lent.
struct OrbImage {
  const std::uint8_t* pixels = nullptr;
  int width = 0, height = 0, stride = 0;  // stride in bytes
};

struct OrbPoint {
  Eigen::Vector2f pixel;
  float distance_m = 0;  // sets the size of the patch, so that near and far views of a thing compare; 0: not known
};

// One a point, in order; none for those too near to the border. Allocates; not for the real-time thread.
std::vector<std::optional<OrbDescriptor>> describe(const OrbImage& image, std::span<const OrbPoint> points);

}  // namespace lxd
