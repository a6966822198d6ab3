// SPDX-License-Identifier: Apache-2.0
// Which vertices an image shows, and how well.
#pragma once

#include "backend/colour/depth_image.hpp"

namespace lxd {

struct SightLimits {
  float range_max_m = 40;
  float spacing_m = 0.1F;  // between the mesh's vertices: what each stands for
};

// 0: not seen: turned away, too far, hidden, or so near the rim of what hides it that its pixel may be of that. Else up
// to 1: by the angle, by the pixels that show it, less where it is at a rim itself. Nobody asks for less than
// weight_min: it may be 0 then.
float sight_weight(const MeshVertex& vertex, const VertexSight& sighting, const Eigen::Matrix3f& R_camera_mesh,
                   const PinholeView& view, const DepthImage& depth, const SightLimits& limits, float weight_min);

// Pixels that a vertex stands for, across.
inline float width_px(const VertexSight& sighting, const PinholeView& view, const SightLimits& limits) {
  return view.focal_px * limits.spacing_m * sighting.inverse_m;
}

}  // namespace lxd
