// SPDX-License-Identifier: Apache-2.0
// The features' lives: from candidate to mature by surface or triangulation, anchors that move on, what moves by
// itself, and storage that stays where it is.
#include <cmath>
#include <map>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "rt/allocation_guard.hpp"
#include "tests/support/feature_scene.hpp"

namespace lxd::estimator_feature_store_test {
namespace {

using Eigen::Vector3d;
using test::FeatureScene;

class FeatureStoreTest : public testing::Test {
 protected:
  explicit FeatureStoreTest(bool with_map = true) : scene(with_map) {}

  void run(int images, const Pose& error = {}) {
    for (int i = 0; i < images; ++i, t_s += FeatureScene::kPeriod_s) {
      store.begin(scene.frame(t_s));
      store.conclude(FeatureScene::pose(t_s) * error, scene.cast.map, 1);
    }
  }
  [[nodiscard]] const Vector3d& truth(const FeatureTrack& track) const { return scene.points[track.id - 1].p_m; }

  // Mean squared normalised error of the mature ones' places, three degrees of freedom; the largest left out.
  [[nodiscard]] double landmark_nees() {
    std::vector<double> squares;
    std::size_t i = 0;
    const auto landmarks = store.landmarks();
    for (const FeatureTrack& track : store.tracks()) {
      if (track.stage != FeatureStage::mature) continue;
      const Vector3d error = landmarks[i].p_world_m - truth(track);
      squares.push_back(error.dot(landmarks[i++].covariance_m2.inverse() * error));
    }
    std::sort(squares.begin(), squares.end());
    squares.resize(squares.size() * 95 / 100);
    double sum = 0;
    for (const double square : squares) sum += square;
    return sum / static_cast<double>(std::max<std::size_t>(squares.size(), 1));
  }

  test::OwnedArena arena{std::size_t{1} << 20};
  FeatureScene scene;
  FeatureStore store{scene.camera, {}, *arena};
  double t_s = 0;
};

class FeatureStoreWithoutMapTest : public FeatureStoreTest {
 protected:
  FeatureStoreWithoutMapTest() : FeatureStoreTest(false) {}
};

// Seen three times and met by a ray each time: then it takes part, and is where its covariance says.
TEST_F(FeatureStoreTest, FeaturesOnSurfacesMatureWithTheThirdImage) {
  scene.add_on_surfaces(120);
  run(2);
  EXPECT_EQ(store.counters().mature, 0U);
  EXPECT_TRUE(store.landmarks().empty());
  run(1);
  const auto count = static_cast<std::uint32_t>(store.tracks().size());
  EXPECT_GT(count, 60U);
  EXPECT_GT(store.counters().mature, count * 3 / 4);
  EXPECT_EQ(store.landmarks().size(), store.counters().mature);
  EXPECT_LT(landmark_nees(), 4);
  EXPECT_GT(landmark_nees(), 0.2);
}

TEST_F(FeatureStoreWithoutMapTest, WithoutASurfaceTheyAreTriangulated) {
  scene.add_in_the_air(100);
  run(3);
  EXPECT_EQ(store.counters().mature, 0U);  // there is no parallax yet
  run(9);
  const auto count = static_cast<std::uint32_t>(store.tracks().size());
  EXPECT_GT(count, 40U);
  EXPECT_GT(store.counters().mature, count / 2);
  EXPECT_GT(store.counters().triangulated, 20U);
  EXPECT_EQ(store.counters().surfaces, 0U);
  EXPECT_LT(landmark_nees(), 4.5);
}

// Over six seconds the window of ten frames passes many times; anchors move on and the places stay.
TEST_F(FeatureStoreTest, AnchorsMoveOnAndPlacesStay) {
  scene.add_on_surfaces(150);
  run(60);
  EXPECT_GT(store.counters().anchors_shifted, 200U);
  EXPECT_GT(store.counters().mature, 30U);
  EXPECT_LT(landmark_nees(), 4.5);
  for (const FeatureTrack& track : store.tracks()) {
    if (track.anchor == kNoFrame) continue;
    EXPECT_GE(track.anchor, store.window().oldest());
    EXPECT_LE(track.anchor, store.window().newest());
    EXPECT_NEAR(track.point.bearing.norm(), 1, 1e-9);
  }
  EXPECT_LT(store.counters().rejected, 6U);
}

// A cart crosses at 0.6 m/s: its features are rejected in a second, and hardly any of those that stand.
TEST_F(FeatureStoreTest, WhatMovesByItselfIsRejected) {
  scene.add_on_surfaces(120);
  const auto first_moving = static_cast<std::uint32_t>(scene.points.size());
  scene.add_moving(30, {0, 0.6, 0});
  run(12);
  int moving = 0, accused = 0, standing = 0, wrongly = 0;
  for (const FeatureTrack& track : store.tracks()) {
    const bool on_cart = track.id > first_moving;
    (on_cart ? moving : standing) += 1;
    (on_cart ? accused : wrongly) +=
        on_cart ? track.stage != FeatureStage::mature : track.stage == FeatureStage::rejected;
  }
  EXPECT_GT(moving, 15);
  EXPECT_GE(accused, moving * 9 / 10);
  EXPECT_LE(wrongly, standing / 50);
}

// A pose that is off by two pixels for all is the pose's fault, when the residuals' scale says so.
TEST_F(FeatureStoreTest, AWrongPoseAccusesNobodyWhenTheScaleTells) {
  scene.add_on_surfaces(120);
  run(6);
  const Pose error{Exp(Vector3d(0, 0, 0.006)), Vector3d::Zero()};
  for (int i = 0; i < 4; ++i, t_s += FeatureScene::kPeriod_s) {
    store.begin(scene.frame(t_s));
    store.conclude(FeatureScene::pose(t_s) * error, scene.cast.map, 4);
  }
  EXPECT_LT(store.counters().rejected, 4U);
}

TEST_F(FeatureStoreTest, TheLostAreForgottenAndIdsNeverConfused) {
  scene.add_on_surfaces(60);
  run(4);
  const auto before = store.counters();
  const auto count = store.tracks().size();
  store.begin(scene.frame(t_s, 1000));
  EXPECT_EQ(store.counters().lost - before.lost, count);
  for (const FeatureTrack& track : store.tracks()) {
    EXPECT_EQ(track.images, 1U);
    EXPECT_EQ(track.stage, FeatureStage::candidate);
  }
  EXPECT_TRUE(store.landmarks().empty());
  store.begin({});
  EXPECT_TRUE(store.tracks().empty());
  store.conclude(FeatureScene::pose(t_s), scene.cast.map, 1);
  store.clear();
  EXPECT_TRUE(store.window().empty());
}

TEST_F(FeatureStoreTest, WhatIsNoNumberDoesNoHarm) {
  scene.add_on_surfaces(60);
  run(4);
  const std::uint32_t mature = store.counters().mature;
  FeatureFrame frame = scene.frame(t_s);
  frame.storage[0].pixel[0] = NAN;
  frame.storage[1].bearing[2] = NAN;
  const std::uint32_t count = frame.count;
  store.begin(frame);
  EXPECT_EQ(store.tracks().size(), count - 2);
  Pose broken = FeatureScene::pose(t_s);
  broken.p.x() = NAN;
  store.conclude(broken, scene.cast.map, 1);
  t_s += FeatureScene::kPeriod_s;
  run(1);
  EXPECT_GE(store.counters().mature + 6, mature);
  for (const VisualObservation& seen : store.landmarks()) EXPECT_TRUE(seen.p_world_m.allFinite());
}

class EstimatorVisionRealTime : public FeatureStoreTest {};

TEST_F(EstimatorVisionRealTime, AnImagesWholeWayAllocatesNothing) {
  scene.add_on_surfaces(150);
  scene.add_in_the_air(50);
  std::vector<FeatureFrame> frames;
  for (int i = 0; i < 30; ++i) frames.push_back(scene.frame(0.1 * i));
  std::vector<VisualResidual> residuals(kFeaturesMax);
  std::vector<float> scratch(kFeaturesMax);
  std::size_t used = 0;
#ifndef LXD_SANITIZED
  ASSERT_TRUE(AllocationGuard::active()) << "this executable does not link lxd_alloc_hook";
#endif
  const AllocationGuard guard;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const Pose T = FeatureScene::pose(0.1 * static_cast<double>(i));
    State x;
    x.R = T.R;
    x.p = T.p;
    store.begin(frames[i]);
    std::size_t count = 0;
    for (const VisualObservation& seen : store.landmarks())
      count += reproject(seen, SweepPath::knot(x, 0.02), scene.camera, 0.5, residuals[count]);
    const auto all = std::span(residuals).first(count);
    const double scale = visual_scale(all, scratch);
    used += accumulate(all, scale, kernel_sigmas(0)).weight > 0;
    store.conclude(T, scene.cast.map, scale);
  }
  EXPECT_EQ(guard.count(), 0U);
  EXPECT_GT(used, 10U);
}

}  // namespace
}  // namespace lxd::estimator_feature_store_test
