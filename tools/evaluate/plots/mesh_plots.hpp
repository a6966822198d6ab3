// SPDX-License-Identifier: Apache-2.0
// Panels of a mesh's errors.
#pragma once

#include "tools/evaluate/plots/plot_axes.hpp"
#include "tools/evaluate/report.hpp"

namespace lxd {

// How far the mesh is off the world: a histogram.
void draw_distances(Canvas& canvas, const PanelPlace& place, const MeshErrors& mesh);

// Claimed against actual error, decile by decile: on the diagonal the mesh knows itself.
void draw_reliability(Canvas& canvas, const PanelPlace& place, const MeshErrors& mesh);

}  // namespace lxd
