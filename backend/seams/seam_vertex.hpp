// SPDX-License-Identifier: Apache-2.0
// A vertex while seams are fused: as it came, and then what becomes of it.
#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "backend/vertex_colour.hpp"

namespace lxd {

enum class SeamFate : std::uint8_t {
  alone,       // no other sub-mesh shows its surface: as it was
  fused,       // others do; it is where all together say, and its sub-mesh is the one that shows the surface here
  to_later,    // a later sub-mesh shows the surface here
  to_earlier,  // an earlier one does
};

struct SeamVertex {
  Eigen::Vector3f position_m;  // from its tile's lowest corner, axes of the map
  Eigen::Vector3f normal;
  float variance_m2 = 0;
  VertexColour colour;
  std::uint32_t submesh = 0;  // counted in the archive's order
  std::uint32_t vertex = 0;   // of the sub-mesh
  std::uint8_t rings = 0;     // from its sub-mesh's rim
  bool in_halo = false;       // of its tile, not within
  SeamFate fate = SeamFate::alone;

  // Its sub-mesh shows the surface here.
  [[nodiscard]] bool stays() const { return fate == SeamFate::alone || fate == SeamFate::fused; }
};

}  // namespace lxd
