// SPDX-License-Identifier: Apache-2.0
// Colours of the overview.
#pragma once

#include <array>

#include "backend/overview_raster.hpp"

namespace lxd {

inline const Colour kBackground{0.055F, 0.067F, 0.090F};
inline const Colour kInk{0.90F, 0.93F, 0.96F};
inline const Colour kFaintInk{0.55F, 0.60F, 0.67F};
inline const Colour kStartMark{0.30F, 0.87F, 0.50F};
inline const Colour kEndMark{1.00F, 0.33F, 0.36F};

// Of curves that must be told apart, in this order: sky, amber, green, pink, violet, sand. Chosen to differ in
// lightness, too, for those who do not see all hues.
inline const std::array<Colour, 6> kCurves{{{0.36F, 0.69F, 1.00F},
                                            {1.00F, 0.66F, 0.26F},
                                            {0.44F, 0.87F, 0.57F},
                                            {1.00F, 0.47F, 0.66F},
                                            {0.66F, 0.58F, 1.00F},
                                            {0.87F, 0.84F, 0.67F}}};
inline const Colour kPlotGround{0.078F, 0.094F, 0.125F};

// Perceptually even from low (deep blue) over green to high (yellow): nine knots of matplotlib's viridis (CC0), its
// darkest ones lifted to stand out from the background. at: 0..1.
Colour height_colour(double at);
// Time along the path: from white-gold to magenta, which no height has. at: 0..1.
Colour time_colour(double at);

}  // namespace lxd
