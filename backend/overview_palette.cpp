// SPDX-License-Identifier: Apache-2.0
// Colour maps, linear between knots.
#include "backend/overview_palette.hpp"

#include <algorithm>
#include <array>

namespace lxd {
namespace {

template <std::size_t N>
Colour between_knots(const std::array<std::array<float, 3>, N>& knots, double at) {
  const double scaled = std::clamp(at, 0.0, 1.0) * static_cast<double>(N - 1);
  const std::size_t below = std::min(static_cast<std::size_t>(scaled), N - 2);
  const auto fraction = static_cast<float>(scaled - static_cast<double>(below));
  const Colour a(knots[below].data()), b(knots[below + 1].data());
  return a + fraction * (b - a);
}

}  // namespace

Colour height_colour(double at) {
  static constexpr std::array<std::array<float, 3>, 9> kKnots{{{0.32F, 0.29F, 0.60F},
                                                               {0.27F, 0.36F, 0.62F},
                                                               {0.21F, 0.44F, 0.60F},
                                                               {0.16F, 0.53F, 0.58F},
                                                               {0.13F, 0.62F, 0.54F},
                                                               {0.27F, 0.71F, 0.45F},
                                                               {0.48F, 0.79F, 0.34F},
                                                               {0.73F, 0.85F, 0.24F},
                                                               {0.99F, 0.91F, 0.26F}}};
  return between_knots(kKnots, at);
}

Colour time_colour(double at) {
  static constexpr std::array<std::array<float, 3>, 4> kKnots{
      {{1.00F, 0.95F, 0.78F}, {1.00F, 0.74F, 0.36F}, {0.98F, 0.45F, 0.36F}, {0.91F, 0.25F, 0.60F}}};
  return between_knots(kKnots, at);
}

}  // namespace lxd
