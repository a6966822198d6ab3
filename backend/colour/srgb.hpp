// SPDX-License-Identifier: Apache-2.0
// The curve of eight-bit images (IEC 61966-2-1, sRGB): from their levels to light and back. Light adds up; levels do
// not.
#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

namespace lxd {

// 0 .. 1 of each level.
using Lights = std::array<float, 256>;
const Lights& lights();
// The level of a light; beyond 0 .. 1 the nearest.
std::uint8_t level_of(float light);

inline float light_of(std::uint8_t level) { return lights()[level]; }
inline Eigen::Array3f light_of(const std::uint8_t* rgb, const Lights& light = lights()) {
  return {light[rgb[0]], light[rgb[1]], light[rgb[2]]};
}

// The light between four pixels, `part` of the way to the next ones. upper, lower: the left ones, of three channels.
inline Eigen::Array3f light_between(const std::uint8_t* upper, const std::uint8_t* lower, const Eigen::Vector2f& part,
                                    const Lights& light) {
  const Eigen::Array3f above =
      light_of(upper, light) + part.x() * (light_of(upper + 3, light) - light_of(upper, light));
  const Eigen::Array3f below =
      light_of(lower, light) + part.x() * (light_of(lower + 3, light) - light_of(lower, light));
  return above + part.y() * (below - above);
}

}  // namespace lxd
