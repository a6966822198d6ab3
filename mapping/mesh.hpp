// SPDX-License-Identifier: Apache-2.0
// The extracted mesh as it is handed to the back-end: indexed triangles whose faces share vertices.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

namespace lxd {

struct MeshVertex {
  Eigen::Vector3f position_m;  // sub-mesh frame
  Eigen::Vector3f normal;      // unit, towards the side that the LiDAR saw
  float variance_m2;           // of the position along the normal
};

using MeshFace = std::array<std::uint32_t, 3>;  // counter-clockwise seen from the normal's side

}  // namespace lxd
