// SPDX-License-Identifier: Apache-2.0
// Key frames get the image nearest to them, and what the filter knew of its features; images that nobody asks for take
// no more room than they may.
#include <gtest/gtest.h>

#include "board/sight_intake.hpp"
#include "rt/so3.hpp"
#include "tests/support/texture_video.hpp"

namespace lxd::board_sight_intake_test {
namespace {

constexpr std::size_t kRoom = 4 * test::TextureVideo::kWidth * test::TextureVideo::kHeight;

RigTime at(double s) { return RigTime::from_seconds(100 + s); }

class SightIntakeStory : public testing::Test {
 protected:
  SightIntakeStory() {
    const test::VideoImage image = test::TextureVideo().image(Eigen::Matrix3d::Identity(), 0);
    pixels_ = {test::TextureVideo::kWidth, test::TextureVideo::kHeight, image.pixels};
    for (int i = 0; i < 10; ++i)
      features_.push_back({{100.0F + 30 * static_cast<float>(i), 200}, {0, 0, 1}, i < 6 ? 8.0F : 0.0F, 0.1F});
  }
  static MountedCamera camera() {
    CameraIntrinsics intrinsics;
    intrinsics.resolution = {test::TextureVideo::kWidth, test::TextureVideo::kHeight};
    intrinsics.focal_px = {400, 400};
    return {CameraModel(intrinsics), {Eigen::Matrix3d::Identity(), {0.1, 0, 0}}};
  }
  void offer(double s) { intake_.images().offer(pixels_, at(s)); }
  void note(std::int64_t id, double s, const Pose& T) {
    KeyFrame frame;
    frame.id = id;
    frame.stamp = at(s);
    frame.T_world_body = T;
    intake_.note(frame);
  }
  [[nodiscard]] SightedImage sighted(double s, const Pose& T) const {
    return {at(s), T * camera().T_body_camera, features_};
  }

  GreyPixels pixels_;
  std::vector<SightedFeature> features_;
  SightIntake intake_{camera(), 0.5, kRoom};
};

// Given a key frame and an image a moment earlier, then the camera's place is told in the key frame's body.
TEST_F(SightIntakeStory, AKeyFrameGetsItsImage) {
  offer(0.95);
  note(7, 1, {Exp(Eigen::Vector3d(0, 0, 0.5)), {3, 0, 0}});
  const auto seen = intake_.take(sighted(0.95, {Exp(Eigen::Vector3d(0, 0, 0.5)), {2, 0, 0}}));
  ASSERT_TRUE(seen);
  EXPECT_EQ(seen->key_frame, 7);
  const Eigen::Vector3d wanted =
      Exp(Eigen::Vector3d(0, 0, -0.5)) * Eigen::Vector3d(-1, 0, 0) + Eigen::Vector3d(0.1, 0, 0);
  EXPECT_LT((seen->T_body_camera.p - wanted).norm(), 1e-12);
  const VisualKeyFrame frame = describe(*seen);
  ASSERT_EQ(frame.features.size(), features_.size());
  EXPECT_FLOAT_EQ(frame.features[0].distance_m, 8);
  EXPECT_FALSE(frame.features[9].has_point());
  EXPECT_NE(frame.features[0].descriptor, frame.features[5].descriptor);
}

TEST_F(SightIntakeStory, WithoutACameraInTheSweepTheNextOneServes) {
  note(7, 1, {});
  EXPECT_FALSE(intake_.take({}));
  offer(1.1);
  EXPECT_TRUE(intake_.take(sighted(1.1, {})));
  EXPECT_FALSE(intake_.take(sighted(1.1, {}))) << "one image a key frame";
}

TEST_F(SightIntakeStory, AnImageThatIsLongAfterIsNone) {
  note(7, 1, {});
  offer(2);
  EXPECT_FALSE(intake_.take(sighted(2, {})));
}

TEST_F(SightIntakeStory, ImagesThatMadeRoomAreCounted) {
  for (int i = 0; i < 20; ++i) offer(0.1 * i);
  note(7, 0.1, {});
  EXPECT_FALSE(intake_.take(sighted(0.1, {})));
  EXPECT_EQ(intake_.counts().images_gone, 1U);
  EXPECT_EQ(intake_.images().bytes(), kRoom);
}

TEST_F(SightIntakeStory, WhenTheFilterBeginsAgainNobodyWaits) {
  note(7, 1, {});
  intake_.begin_again();
  offer(1.05);
  EXPECT_FALSE(intake_.take(sighted(1.05, {})));
}

}  // namespace
}  // namespace lxd::board_sight_intake_test
