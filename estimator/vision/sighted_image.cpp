// SPDX-License-Identifier: Apache-2.0
#include "estimator/vision/sighted_image.hpp"

#include <cmath>
#include <cstddef>

namespace lxd {
namespace {

SightedFeature seen(const FeatureTrack& track) {
  const Eigen::Vector2f pixel = track.pixel.cast<float>();
  const Eigen::Vector3f bearing = track.bearing.cast<float>();
  return {{pixel.x(), pixel.y()}, {bearing.x(), bearing.y(), bearing.z()}, 0, 0};
}

// sigma_d = sigma_rho / rho^2.
SightedFeature seen_at_a_distance(const FeatureTrack& track, const Pose& T_camera_anchor) {
  SightedFeature out = seen(track);
  const InverseDepth depth = shifted(track.point, T_camera_anchor).depth;
  out.distance_m = static_cast<float>(1 / depth.rho);
  out.distance_sigma_m = static_cast<float>(std::sqrt(depth.variance) / (depth.rho * depth.rho));
  return out;
}

}  // namespace

std::span<const SightedFeature> sight(std::span<const FeatureTrack> tracks, const FeatureWindow& window,
                                      const Pose& T_world_camera, std::span<SightedFeature> storage) noexcept {
  std::size_t count = 0;
  const Pose T_camera_world = T_world_camera.inverse();
  for (const FeatureTrack& track : tracks)
    if (track.stage == FeatureStage::mature)
      storage[count++] = seen_at_a_distance(track, T_camera_world * window[track.anchor].T_world_camera);
  for (const FeatureTrack& track : tracks)
    if (track.stage == FeatureStage::candidate) storage[count++] = seen(track);
  return storage.first(count);
}

}  // namespace lxd
