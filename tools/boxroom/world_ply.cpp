// SPDX-License-Identifier: Apache-2.0
#include "tools/boxroom/world_ply.hpp"

#include <array>

#include <fmt/format.h>

namespace lxd::boxroom {
namespace {

constexpr int kCorners = 8;  // corner i is at the high end of axis k where bit k of i is set
// Corners of each side in turn around it, seen from outside.
constexpr std::array<std::array<int, 4>, 6> kSides{
    {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};

std::string corners_of(const Box& box) {
  std::string lines;
  for (int i = 0; i < kCorners; ++i) {
    const auto at = [&](int axis) { return (i >> axis & 1) != 0 ? box.high_m[axis] : box.low_m[axis]; };
    lines += fmt::format("{:.9g} {:.9g} {:.9g}\n", at(0), at(1), at(2));
  }
  return lines;
}

std::string sides_of(std::size_t first_corner) {
  std::string lines;
  for (const auto& [a, b, c, d] : kSides) {
    lines += fmt::format("3 {} {} {}\n", first_corner + a, first_corner + b, first_corner + c);
    lines += fmt::format("3 {} {} {}\n", first_corner + a, first_corner + c, first_corner + d);
  }
  return lines;
}

}  // namespace

std::string world_ply(const World& world) {
  const std::size_t solids = world.boxes().size() + 1;
  std::string text = fmt::format(
      "ply\nformat ascii 1.0\ncomment true surfaces, metres\nelement vertex {}\nproperty float x\nproperty float y\n"
      "property float z\nelement face {}\nproperty list uchar int vertex_indices\nend_header\n",
      solids * kCorners, solids * 2 * kSides.size());
  text += corners_of(world.hall());
  for (const Box& box : world.boxes()) text += corners_of(box);
  for (std::size_t i = 0; i < solids; ++i) text += sides_of(i * kCorners);
  return text;
}

}  // namespace lxd::boxroom
