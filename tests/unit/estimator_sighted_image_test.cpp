// SPDX-License-Identifier: Apache-2.0
// What the filter says of an image's features to those who want to know the place again.
#include <gtest/gtest.h>

#include "estimator/vision/sighted_image.hpp"

namespace lxd::estimator_sighted_image_test {
namespace {

FeatureTrack track(FeatureStage stage, double distance_m, double sigma_m) {
  FeatureTrack out;
  out.stage = stage;
  out.anchor = 0;
  out.pixel = {100, 50};
  out.point.depth = inverse_of(distance_m, sigma_m * sigma_m);
  return out;
}

// Given a camera that has come 2 m nearer than where the features are anchored, then distances are from where it is
// now, and only of those that are mature.
TEST(SightedImage, DistancesAreOfTheImage) {
  FeatureWindow window;
  window.push({});
  const std::vector<FeatureTrack> tracks{track(FeatureStage::candidate, 5, 0.1), track(FeatureStage::mature, 10, 0.2),
                                         track(FeatureStage::rejected, 8, 0.1)};
  std::array<SightedFeature, 8> storage;
  const auto seen = sight(tracks, window, {Eigen::Matrix3d::Identity(), {0, 0, 2}}, storage);
  ASSERT_EQ(seen.size(), 2U);
  EXPECT_NEAR(seen[0].distance_m, 8, 1e-5);
  EXPECT_NEAR(seen[0].distance_sigma_m, 0.2, 1e-4) << "ahead: no better known than from the anchor";
  EXPECT_EQ(seen[0].pixel, (std::array{100.0F, 50.0F}));
  EXPECT_EQ(seen[1].distance_m, 0);
}

}  // namespace
}  // namespace lxd::estimator_sighted_image_test
