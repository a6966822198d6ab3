// SPDX-License-Identifier: Apache-2.0
// The curve of eight-bit images (IEC 61966-2-1, sRGB): from their levels to light and back. Light adds up; levels do
// not.
#pragma once

#include <cstdint>

#include <Eigen/Core>

namespace lxd {

// 0 .. 1 of a level.
float light_of(std::uint8_t level);
// The level of a light; beyond 0 .. 1 the nearest.
std::uint8_t level_of(float light);

inline Eigen::Array3f light_of(const std::uint8_t* rgb) {
  return {light_of(rgb[0]), light_of(rgb[1]), light_of(rgb[2])};
}

}  // namespace lxd
