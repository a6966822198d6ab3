// SPDX-License-Identifier: Apache-2.0
// The mesh's part of the overview: a sample of vertices to fit the views by, then every triangle into each view.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "backend/archive.hpp"
#include "backend/overview_raster.hpp"
#include "backend/overview_view.hpp"

namespace lxd {

// At most about kSamplesMax finite vertices in the map frame, evenly taken out of all.
inline constexpr std::uint64_t kSamplesMax = 40'000;
Result<std::vector<Eigen::Vector3d>> sample_vertices(const Archive& archive);

struct Panel {
  View view;
  Raster raster;
};

// Coloured as cameras saw it where any colour is known, else by height; shaded by a light at the eye. heights: inner
// interval of the vertices' z.
Status draw_mesh(const Archive& archive, const Interval& heights, Panel& panel);

}  // namespace lxd
