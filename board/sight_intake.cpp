// SPDX-License-Identifier: Apache-2.0
#include "board/sight_intake.hpp"

#include <algorithm>
#include <span>

#include "backend/pnp/orb.hpp"

namespace lxd {
namespace {

// What descriptors take for one point is one within so much, besides how well it is followed: seen a second time, a
// corner of a coarse patch is found elsewhere on it. With half a pixel loops in a room claimed 4 cm and were off by 10.
constexpr double kDescribedSigma_px = 1.5;
// The path from a key frame to its image is the filter's: over so short a time it has not drifted.
constexpr Duration kApartMax = Duration::from_ns(300'000'000);

VisualFeature feature_of(const SightedFeature& seen, const OrbDescriptor& descriptor, float bearing_sigma_rad) {
  const auto& [x, y, z] = seen.bearing;
  return {descriptor, {x, y, z}, bearing_sigma_rad, seen.distance_m, seen.distance_sigma_m};
}

}  // namespace

SightIntake::SightIntake(const MountedCamera& camera, double pixel_sigma_px, std::size_t image_bytes)
    : bearing_sigma_rad_(static_cast<float>(Eigen::Vector2d(pixel_sigma_px, kDescribedSigma_px).norm() /
                                            camera.model.intrinsics().focal_px.mean())),
      images_(image_bytes) {}

std::optional<SightedKeyFrame> SightIntake::take(const SightedImage& sighted) {
  if (!waiting_ || sighted.stamp == kNever) return std::nullopt;
  const KeyFrame frame = *waiting_;
  waiting_.reset();
  if (sighted.stamp - frame.stamp > kApartMax) return std::nullopt;
  auto image = images_.take(sighted.stamp);
  if (!image) {
    ++counts_.images_gone;
    return std::nullopt;
  }
  return SightedKeyFrame{frame.id, frame.T_world_body.inverse() * sighted.T_world_camera,
                         std::vector(sighted.features.begin(), sighted.features.end()), bearing_sigma_rad_,
                         std::move(image)};
}

VisualKeyFrame describe(const SightedKeyFrame& sighted) {
  const GreyPixels& image = *sighted.image;
  const OrbImage pixels{image.data.data(), static_cast<int>(image.width), static_cast<int>(image.height),
                        static_cast<int>(image.width)};
  std::vector<OrbPoint> points;
  for (const SightedFeature& seen : sighted.features)
    points.push_back({{seen.pixel[0], seen.pixel[1]}, seen.distance_m});
  const auto descriptors = describe(pixels, points);
  VisualKeyFrame out{sighted.key_frame, sighted.T_body_camera, {}};
  for (std::size_t i = 0; i < descriptors.size(); ++i)
    if (descriptors[i])
      out.features.push_back(feature_of(sighted.features[i], *descriptors[i], sighted.bearing_sigma_rad));
  return out;
}

}  // namespace lxd
