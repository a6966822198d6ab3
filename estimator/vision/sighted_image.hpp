// SPDX-License-Identifier: Apache-2.0
// What the filter knows of one image after its update: where the features are, for whoever wants to know the place
// again. Plain memory of a fixed size; real-time thread.
#pragma once

#include <array>
#include <span>

#include "estimator/vision/feature_track.hpp"
#include "rt/pose.hpp"
#include "rt/time.hpp"

namespace lxd {

struct SightedFeature {
  std::array<float, 2> pixel{};    // column, row, distorted as the lens does
  std::array<float, 3> bearing{};  // unit, camera frame
  float distance_m = 0;            // along the bearing; 0: not known well enough
  float distance_sigma_m = 0;
};

struct SightedImage {
  RigTime stamp = kNever;                    // never: there is none
  Pose T_world_camera;                       // at stamp
  std::span<const SightedFeature> features;  // valid until the filter's next step
};

// Mature features first, then those whose distance is not known; none that was rejected. `storage` has room for all.
std::span<const SightedFeature> sight(std::span<const FeatureTrack> tracks, const FeatureWindow& window,
                                      const Pose& T_world_camera, std::span<SightedFeature> storage) noexcept;

}  // namespace lxd
