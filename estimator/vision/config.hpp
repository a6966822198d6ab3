// SPDX-License-Identifier: Apache-2.0
// Every number of the visual part that a user may set, with its default.
#pragma once

namespace lxd {

struct VisionConfig {
  double pixel_sigma_px = 0.5;       // of a tracked pixel
  double anchor_sigma_m = 0.02;      // of an anchor's pose against the map that the present pose is told from
  double anchor_sigma_rad = 0.0026;  // likewise
  double range_max_m = 80;           // of rays into the map
  int rays_per_image = 100;          // at most
  double parallax_min_rad = 0.03;    // between the rays of a triangulation
};

}  // namespace lxd
