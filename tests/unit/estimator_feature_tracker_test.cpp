// SPDX-License-Identifier: Apache-2.0
// The visual front-end on images whose motion is known: how near, how many, and what it does with images that are bad.
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include "estimator/vision/front_end/feature_tracker.hpp"
#include "tests/support/cameras.hpp"
#include "tests/support/texture_video.hpp"

namespace lxd::estimator_feature_tracker_test {
namespace {

using Eigen::Vector2d;
using test::motion;
using test::shift;
using test::TextureVideo;
using test::VideoImage;
using test::Warp;
using test::warped;

const Feature* find(const FeatureFrame& frame, std::uint32_t id) {
  const auto all = frame.features();
  const auto at = std::find_if(all.begin(), all.end(), [id](const Feature& f) { return f.id == id; });
  return at == all.end() ? nullptr : &*at;
}

// What became of the features of one image in another.
struct Survival {
  int candidates = 0;  // still on the image, 25 pixels from its edge
  int found = 0;
  double rms_px = 0, worst_px = 0;

  Survival(const FeatureFrame& before, const FeatureFrame& now, const Warp& H) {
    const CameraModel camera(test::plain_camera());
    double sum = 0;
    for (const Feature& feature : before.features()) {
      const Vector2d expected = warped(H, feature.pixel_px());
      if (!camera.contains(expected, 25)) continue;
      ++candidates;
      const Feature* const again = find(now, feature.id);
      if (again == nullptr) continue;
      ++found;
      const double error = (again->pixel_px() - expected).norm();
      sum += error * error;
      worst_px = std::max(worst_px, error);
    }
    rms_px = std::sqrt(sum / std::max(found, 1));
  }
  [[nodiscard]] double share() const { return found / static_cast<double>(std::max(candidates, 1)); }
};

class FeatureTrackerTest : public testing::Test {
 protected:
  FeatureFrame next(const Warp& H, std::span<const PredictedPixel> predictions = {}) {
    const VideoImage image = video.image(H, t_s += 0.1);
    FeatureFrame frame;
    sound = tracker.track(image.grey, predictions, frame);
    return frame;
  }

  TextureVideo video;
  FeatureTracker tracker{CameraModel(test::plain_camera()), {}};
  double t_s = 0;
  bool sound = false;
};

TEST_F(FeatureTrackerTest, TheFirstImageIsCoveredWithFeatures) {
  const FeatureFrame frame = next(Warp::Identity());
  ASSERT_TRUE(sound);
  EXPECT_GT(frame.count, 140U);
  std::set<int> buckets;
  for (const Feature& a : frame.features()) {
    EXPECT_EQ(a.age, 0U);
    EXPECT_NEAR(a.direction().norm(), 1, 1e-6);
    buckets.insert(static_cast<int>(a.pixel[0] / 80) + 8 * static_cast<int>(a.pixel[1] / 80));
    for (const Feature& b : frame.features()) EXPECT_TRUE(a.id == b.id || (a.pixel_px() - b.pixel_px()).norm() > 13);
  }
  EXPECT_GE(buckets.size(), 46U);
}

// Given a camera that turns, comes nearer and moves; then each step is followed within a tenth of a pixel, and few are
// lost.
TEST_F(FeatureTrackerTest, FollowsAKnownMotionWithinATenthOfAPixel) {
  Warp H = Warp::Identity();
  const FeatureFrame first = next(H);
  FeatureFrame before = first;
  for (int i = 1; i <= 8; ++i) {
    const Warp step = motion(0.012, 1.01, 5, -3, 2e-6);
    H = step * H;
    const FeatureFrame now = next(H);
    const Survival survival(before, now, step);
    EXPECT_LT(survival.rms_px, 0.1) << i;
    EXPECT_GT(survival.share(), 0.95) << i;
    EXPECT_GT(now.count, 140U);
    before = now;
  }
  const Survival whole(first, before, H);
  RecordProperty("rms_px", std::to_string(whole.rms_px));
  RecordProperty("share", std::to_string(whole.share()));
  EXPECT_LT(whole.rms_px, 0.45);  // the patch is moved, not turned: what turns it adds up
  EXPECT_GT(whole.share(), 0.75);
}

// Sixty pixels between two images are too far for the search alone, and nothing with a prediction.
TEST_F(FeatureTrackerTest, PredictionsBridgeLargeMotion) {
  const Warp jump = shift(75, -40);
  const FeatureFrame first = next(Warp::Identity());
  std::vector<PredictedPixel> predictions;
  for (const Feature& feature : first.features())
    predictions.push_back({feature.id, (warped(jump, feature.pixel_px()) + Vector2d(2, -3)).cast<float>()});
  predictions.push_back({4'000'000, {1, 1}});              // of nobody
  predictions.push_back({first.storage[0].id, {NAN, 1}});  // no number
  const Survival predicted(first, next(jump, predictions), jump);
  EXPECT_GT(predicted.share(), 0.93);
  EXPECT_LT(predicted.rms_px, 0.1);
}

TEST_F(FeatureTrackerTest, ATurnIsPredictedByTheGyroscope) {
  const FeatureFrame first = next(Warp::Identity());
  const CameraModel camera(test::plain_camera());
  const Eigen::Matrix3d R = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY()).toRotationMatrix();
  std::vector<PredictedPixel> predictions(kFeaturesMax);
  const std::size_t count = predict_by_turn(first, R, camera, predictions);
  EXPECT_GT(count, first.count / 2);
  EXPECT_LT(count, first.count);
  Eigen::Matrix3d K;
  K << 420, 0, 322, 0, 425, 241, 0, 0, 1;
  const Warp H = K * R * K.inverse();
  for (const PredictedPixel& p : std::span(predictions).first(count))
    EXPECT_LT((warped(H, find(first, p.id)->pixel_px()) - p.pixel.cast<double>()).norm(), 1e-3);
  const Survival survival(first, next(H, std::span(predictions).first(count)), H);
  EXPECT_GT(survival.share(), 0.9);
  EXPECT_LT(survival.rms_px, 0.2);
}

// The exposure control jumps: the same light, other grey levels.
TEST_F(FeatureTrackerTest, AJumpOfTheExposureLosesFew) {
  for (const double gain : {0.45, 1.15}) {
    video.gain = 0.8;
    tracker.clear();
    const FeatureFrame before = next(Warp::Identity());
    video.gain = gain;
    const Survival survival(before, next(shift(6, 4)), shift(6, 4));
    EXPECT_GT(survival.share(), 0.85) << gain;
    EXPECT_LT(survival.rms_px, 0.12) << gain;
  }
}

// An image that shows nothing is counted; the tracks go on after it.
TEST_F(FeatureTrackerTest, BlindImagesAreCountedAndBridged) {
  const FeatureFrame first = next(Warp::Identity());
  for (const double gain : {0.0, 50.0}) {
    video.gain = gain;
    EXPECT_EQ(next(Warp::Identity()).count, 0U);
    EXPECT_FALSE(sound);
  }
  video.gain = 1;
  const Survival survival(first, next(shift(9, 5)), shift(9, 5));
  EXPECT_TRUE(sound);
  EXPECT_GT(survival.share(), 0.93);
  EXPECT_EQ(tracker.faults()[ImageFault::dark], 1U);
  EXPECT_EQ(tracker.faults()[ImageFault::bright], 1U);
}

TEST_F(FeatureTrackerTest, ADimImageIsStillFollowed) {
  video.gain = 0.12;
  const FeatureFrame first = next(Warp::Identity());
  EXPECT_TRUE(sound);
  const Survival survival(first, next(shift(4, 3)), shift(4, 3));
  EXPECT_GT(survival.found, 40);
  EXPECT_LT(survival.rms_px, 0.4);
}

TEST_F(FeatureTrackerTest, AfterALongGapTracksBeginAnew) {
  const FeatureFrame first = next(Warp::Identity());
  t_s += 1;
  const FeatureFrame later = next(Warp::Identity());
  EXPECT_EQ(Survival(first, later, Warp::Identity()).found, 0);
  EXPECT_GT(later.count, 100U);
}

TEST_F(FeatureTrackerTest, ImagesOfAnotherSizeOrTimeAreCountedAndLeftOut) {
  const FeatureFrame first = next(Warp::Identity());
  VideoImage image = video.image(shift(3, 0), t_s + 0.05);
  FeatureFrame frame;
  GreyImage cut = image.grey;
  cut.width = 320;
  EXPECT_FALSE(tracker.track(cut, {}, frame));
  EXPECT_EQ(tracker.faults()[ImageFault::size_changed], 1U);
  GreyImage torn = image.grey;
  torn.pixels = torn.pixels.first(1000);
  EXPECT_FALSE(tracker.track(torn, {}, frame));
  EXPECT_FALSE(tracker.track({}, {}, frame));
  EXPECT_EQ(tracker.faults()[ImageFault::empty], 2U);
  GreyImage again = image.grey;
  again.stamp = first.stamp;
  EXPECT_FALSE(tracker.track(again, {}, frame));
  EXPECT_EQ(tracker.faults()[ImageFault::not_newer], 1U);
  std::fill(image.pixels.begin(), image.pixels.end(), std::uint8_t{120});
  EXPECT_FALSE(tracker.track(image.grey, {}, frame));
  EXPECT_EQ(tracker.faults()[ImageFault::flat], 1U);
  EXPECT_GT(Survival(first, next(shift(5, 0)), shift(5, 0)).share(), 0.93);
}

// Something moves by itself: its features are its own, and those that it covers are lost, not dragged along.
TEST_F(FeatureTrackerTest, WhatMovesByItselfDoesNotDragOthersAlong) {
  video.patch_moves = true;
  FeatureFrame before = next(Warp::Identity());
  const FeatureFrame first = before;
  for (int i = 1; i <= 5; ++i) {
    video.patch_warp = shift(7 * i, 0);
    before = next(shift(-3 * i, 2 * i));
  }
  int background = 0, patch = 0, neither = 0;
  for (const Feature& feature : first.features()) {
    const Feature* const now = find(before, feature.id);
    if (now == nullptr) continue;
    const bool with_patch = (warped(shift(35, 0), feature.pixel_px()) - now->pixel_px()).norm() < 0.5;
    const bool with_background = (warped(shift(-15, 10), feature.pixel_px()) - now->pixel_px()).norm() < 0.5;
    (with_patch ? patch : with_background ? background : neither) += 1;
  }
  RecordProperty("neither", neither);
  EXPECT_GT(patch, 8);
  EXPECT_GT(background, 90);
  EXPECT_LE(neither, (patch + background) / 20);
}

TEST_F(FeatureTrackerTest, TheSameImagesGiveTheSameFeatures) {
  const auto run = [] {
    TextureVideo film;
    FeatureTracker again(CameraModel(test::radtan_camera()), {});
    FeatureFrame frame;
    for (int i = 0; i < 3; ++i) again.track(film.image(shift(4 * i, i), 0.1 * i + 0.1).grey, {}, frame);
    return frame;
  };
  const FeatureFrame a = run(), b = run();
  ASSERT_EQ(a.count, b.count);
  for (std::uint32_t i = 0; i < a.count; ++i) {
    EXPECT_EQ(a.storage[i].id, b.storage[i].id);
    EXPECT_EQ(a.storage[i].pixel, b.storage[i].pixel);
    EXPECT_EQ(a.storage[i].bearing, b.storage[i].bearing);
  }
}

}  // namespace
}  // namespace lxd::estimator_feature_tracker_test
