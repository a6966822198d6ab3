// SPDX-License-Identifier: Apache-2.0
#include "backend/colour/srgb.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lxd {
namespace {

constexpr float kLevelMax = 255;
// Fine enough that the steepest part of the curve, 12.92 levels of 255 a step, stays within a tenth of a level.
constexpr int kLightSteps = 1 << 15;

float straightened(float level) {
  return level <= 0.04045F ? level / 12.92F : std::pow((level + 0.055F) / 1.055F, 2.4F);
}

float bent(float light) { return light <= 0.0031308F ? 12.92F * light : 1.055F * std::pow(light, 1 / 2.4F) - 0.055F; }

struct Curve {
  Lights light{};
  std::array<std::uint8_t, kLightSteps + 1> level{};

  Curve() {
    for (std::size_t i = 0; i < light.size(); ++i) light[i] = straightened(static_cast<float>(i) / kLevelMax);
    for (std::size_t i = 0; i < level.size(); ++i)
      level[i] = static_cast<std::uint8_t>(std::lround(kLevelMax * bent(static_cast<float>(i) / kLightSteps)));
  }
};

const Curve& curve() {
  static const Curve made;
  return made;
}

}  // namespace

const Lights& lights() { return curve().light; }

std::uint8_t level_of(float light) {
  const float part = std::clamp(light, 0.0F, 1.0F);
  return curve().level[static_cast<std::size_t>(part * kLightSteps + 0.5F)];
}

}  // namespace lxd
