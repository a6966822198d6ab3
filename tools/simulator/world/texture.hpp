// SPDX-License-Identifier: Apache-2.0
// The pattern on every surface: patches with sharp edges, so that a camera finds corners, and finer noise within them.
// A function of the point and the surface's direction alone, the same on every machine.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "tools/simulator/world/world.hpp"

namespace lxd::sim {

// Of a material at a point (world, or the mover's own frame), averaged over the footprint of a beam or pixel: edges are
// as wide, finer features are gone. 0 .. 1.
[[nodiscard]] float textured_albedo(const Material& material, std::uint16_t number, const Eigen::Vector3f& point_m,
                                    const Eigen::Vector3f& normal, float footprint_m);

}  // namespace lxd::sim
