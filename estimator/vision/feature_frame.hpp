// SPDX-License-Identifier: Apache-2.0
// What the vision thread hands to the real-time thread: the features of one image. Plain memory of a fixed size, so
// that it goes through the rings.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

#include <Eigen/Core>

#include "rt/time.hpp"

namespace lxd {

inline constexpr std::uint32_t kFeaturesMax = 256;  // of one image

struct Feature {
  std::uint32_t id = 0;            // of the track; never used again in a run
  std::uint32_t age = 0;           // images in which it was seen before
  std::array<float, 2> pixel{};    // column, row, distorted as the lens does
  std::array<float, 3> bearing{};  // unit, camera frame

  [[nodiscard]] Eigen::Vector2d pixel_px() const { return {pixel[0], pixel[1]}; }
  [[nodiscard]] Eigen::Vector3d direction() const { return {bearing[0], bearing[1], bearing[2]}; }
};

struct FeatureFrame {
  RigTime stamp;            // of the image, at the middle of its exposure where that is known
  std::uint32_t count = 0;  // features in use
  std::array<Feature, kFeaturesMax> storage{};

  [[nodiscard]] std::span<const Feature> features() const {
    return std::span(storage).first(std::min(count, kFeaturesMax));
  }
};

}  // namespace lxd
