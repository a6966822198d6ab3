// SPDX-License-Identifier: Apache-2.0
// One colour of what several images say of a vertex.
#pragma once

#include <span>

#include "backend/colour/gains.hpp"
#include "backend/vertex_colour.hpp"

namespace lxd {

// Samples that are far from what most of the weight says (a passer-by, a reflex) have no part. Images before
// the first counting one are there for their gains alone.
VertexColour fused_colour(std::span<const ColourSample> samples, std::span<const ImageGain> gains,
                          const LensFalloff& falloff, std::size_t first_counting);

}  // namespace lxd
