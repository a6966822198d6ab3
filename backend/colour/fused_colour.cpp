// SPDX-License-Identifier: Apache-2.0
#include "backend/colour/fused_colour.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "backend/colour/srgb.hpp"

namespace lxd {
namespace {

// Of light that a sample may differ by from the middle one, and still be of the same surface: textures and highlights.
constexpr float kAlike = 0.35F, kAlikeLight = 0.03F;

struct CompensatedLight {
  Eigen::Array3f light;
  float weight;

  // What the eye calls bright (ITU-R BT.709).
  [[nodiscard]] float luminance() const { return 0.2126F * light[0] + 0.7152F * light[1] + 0.0722F * light[2]; }
};

// The least bright that half of the weight is not brighter than.
float middle_luminance(std::span<const CompensatedLight> lights) {
  float total = 0, middle = std::numeric_limits<float>::infinity();
  for (const CompensatedLight& light : lights) total += light.weight;
  for (const CompensatedLight& candidate : lights) {
    float below = 0;
    for (const CompensatedLight& light : lights)
      if (light.luminance() <= candidate.luminance()) below += light.weight;
    if (2 * below >= total) middle = std::min(middle, candidate.luminance());
  }
  return middle;
}

}  // namespace

VertexColour fused_colour(std::span<const ColourSample> samples, std::span<const ImageGain> gains,
                          const LensFalloff& falloff, std::size_t first_counting) {
  std::array<CompensatedLight, kSamplesPerVertex> storage;
  std::size_t count = 0;
  for (const ColourSample& sample : samples)
    if (sample.image >= first_counting)
      storage[count++] = {light_of(sample.rgb.data()) * compensation(sample, gains[sample.image], falloff),
                          static_cast<float>(sample.weight)};
  if (count == 0) return {};
  const auto lights = std::span(storage).first(count);
  const float middle = middle_luminance(lights);
  Eigen::Array3f sum = Eigen::Array3f::Zero();
  float weight = 0;
  std::uint8_t views = 0;
  for (const CompensatedLight& light : lights) {
    if (std::abs(light.luminance() - middle) > kAlikeLight + kAlike * middle) continue;
    sum += light.weight * light.light;
    weight += light.weight;
    ++views;
  }
  sum /= weight;
  return {level_of(sum[0]), level_of(sum[1]), level_of(sum[2]), views};
}

}  // namespace lxd
