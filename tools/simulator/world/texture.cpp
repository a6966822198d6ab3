// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/texture.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lxd::sim {
namespace {

constexpr float kTexelMin_m = 1e-3F;

// One layer of the pattern: its features' size against the material's texel, and its part of the contrast.
struct Layer {
  float size;
  float weight;
  bool patches;
};
constexpr std::array<Layer, 4> kLayers{
    {{1.0F, 0.45F, true}, {0.37F, 0.25F, true}, {0.5F, 0.15F, false}, {0.13F, 0.15F, true}}};

// Integer mixing after Murmur3's finaliser (Appleby, public domain).
std::uint32_t mixed(std::uint32_t h) {
  h = (h ^ (h >> 16U)) * 0x85EBCA6BU;
  h = (h ^ (h >> 13U)) * 0xC2B2AE35U;
  return h ^ (h >> 16U);
}

// -1 .. 1, one value a lattice point.
float lattice(std::int32_t i, std::int32_t j, std::uint32_t key) {
  const std::uint32_t h =
      mixed(static_cast<std::uint32_t>(i) * 0x9E3779B1U ^ mixed(static_cast<std::uint32_t>(j) * 0x85EBCA77U ^ key));
  return static_cast<float>(h >> 8U) * 0x1p-23F - 1;
}

// One lattice cell of the two that a footprint of `width` < 1 may reach along an axis, and how far it reaches into the
// second.
struct Reach {
  Reach(float x, float width) {
    const float last = std::floor(x + width / 2);
    cell = static_cast<std::int32_t>(std::floor(x - width / 2));
    beyond = static_cast<float>(cell) < last ? (x + width / 2 - last) / width : 0;
  }
  std::int32_t cell;
  float beyond;
};

// Cells of one value each, averaged over a square footprint: without it their edges would be jagged in an image.
float patch(float u, float v, float width, std::uint32_t key) {
  const Reach a(u, width), b(v, width);
  float value = lattice(a.cell, b.cell, key);
  if (a.beyond > 0) value += a.beyond * (lattice(a.cell + 1, b.cell, key) - value);
  if (b.beyond > 0) {
    float above = lattice(a.cell, b.cell + 1, key);
    if (a.beyond > 0) above += a.beyond * (lattice(a.cell + 1, b.cell + 1, key) - above);
    value += b.beyond * (above - value);
  }
  return value;
}

float value_noise(float u, float v, std::uint32_t key) {
  const float fu = std::floor(u);
  const float fv = std::floor(v);
  const auto i = static_cast<std::int32_t>(fu);
  const auto j = static_cast<std::int32_t>(fv);
  const auto eased = [](float x) { return x * x * (3 - 2 * x); };
  const float a = eased(u - fu);
  const float b = eased(v - fv);
  const float low = lattice(i, j, key) + a * (lattice(i + 1, j, key) - lattice(i, j, key));
  const float high = lattice(i, j + 1, key) + a * (lattice(i + 1, j + 1, key) - lattice(i, j + 1, key));
  return low + b * (high - low);
}

// The pattern lies in the coordinate plane that the surface is nearest to.
int axis_across(const Eigen::Vector3f& normal) {
  Eigen::Index axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  return static_cast<int>(axis);
}

}  // namespace

float textured_albedo(const Material& material, std::uint16_t number, const Eigen::Vector3f& point_m,
                      const Eigen::Vector3f& normal, float footprint_m) {
  if (material.contrast == 0) return material.albedo;
  const int across = axis_across(normal);
  const float u = point_m[(across + 1) % 3];
  const float v = point_m[(across + 2) % 3];
  const float texel_m = std::max(material.texel_m, kTexelMin_m);
  float sum = 0;
  std::uint32_t key = number * 4U + static_cast<std::uint32_t>(across);
  for (const Layer& layer : kLayers) {
    key = mixed(key + 1);
    const float size_m = layer.size * texel_m;
    const float seen = std::min(1.0F, size_m / (2 * footprint_m + kTexelMin_m) - 0.5F);
    if (seen <= 0) continue;
    const float value = layer.patches ? patch(u / size_m, v / size_m, footprint_m / size_m, key)
                                      : value_noise(u / size_m, v / size_m, key);
    sum += layer.weight * seen * value;
  }
  return std::clamp(material.albedo * (1 + material.contrast * sum), 0.0F, 1.0F);
}

}  // namespace lxd::sim
