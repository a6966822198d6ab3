// SPDX-License-Identifier: Apache-2.0
// Where a ray meets one layer of a cell: a height field of 5 x 5 bilinear quads over the cell's square.
#pragma once

#include <Eigen/Core>

#include "mapping/layer.hpp"

namespace lxd {

// A ray's way through one cell, in the cell's frame.
struct CellRay {
  Eigen::Vector3f entry_m;    // where it enters, from the cell's lower corner
  Eigen::Vector3f direction;  // unit
  float cell_size_m;
};

struct LayerCrossing {
  float along_m;           // from the entry; may be a little before it or beyond the exit
  float variance_m2;       // of along_m: the height's variance over the squared sensitivity, incidence included
  Eigen::Vector3f normal;  // unit, world axes, against the ray
  bool front;              // the ray comes from the side on which the LiDAR was
  int quad;
};

// First crossing with one of the quads whose bit is set. Surfaces may stick out of the cell by up to half a spacing
// along their axis. Precondition: finite.
bool first_crossing(const Layer& layer, const CellRay& ray, std::uint32_t quads, LayerCrossing& crossing) noexcept;

}  // namespace lxd
