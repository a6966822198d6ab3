// SPDX-License-Identifier: Apache-2.0
// A live camera's frames through the vision thread's work: features of the right instants, sought where the gyroscope
// says, and handed to another thread in order.
#include <cmath>
#include <cstdlib>

#include <gtest/gtest.h>

#include "board/live_vision.hpp"
#include "rt/so3.hpp"
#include "tests/support/texture_video.hpp"

namespace lxd::board_live_vision_test {
namespace {

constexpr double kFocal_px = 400, kExposure_s = 0.004, kPeriod_s = 0.05;

class LiveVisionWork : public testing::Test {
 protected:
  LiveVisionWork() {
    CameraRig& camera = live_.rig.camera0.emplace();
    camera.resolution = {test::TextureVideo::kWidth, test::TextureVideo::kHeight};
    camera.intrinsics = {kFocal_px, kFocal_px, 320, 240};
    camera.distortion_model = "none";
    camera.wire.pixel_format = "grey";
    camera.wire.exposure_s = kExposure_s;
    live_.sensors.camera = true;
    star_.T_body_camera0 = Pose{};
  }
  [[nodiscard]] std::unique_ptr<LiveVision> vision(bool inertial) {
    return std::make_unique<LiveVision>(live_.rig, *camera_of(live_.rig, star_), inertial, watch(), clock_);
  }
  SensorWatch& watch() {
    if (!watch_) watch_.emplace(live_, events_);
    return *watch_;
  }

  // What a camera sees which has turned by that much about its vertical axis since the first.
  test::VideoImage image(double turned_rad) {
    Eigen::Matrix3d K = Eigen::Matrix3d::Identity();
    K.diagonal() << kFocal_px, kFocal_px, 1;
    K.col(2) << 320, 240, 1;
    const Eigen::Matrix3d R_now_then = Exp(Eigen::Vector3d(0, turned_rad, 0)).transpose();
    return video_.image(K * R_now_then * K.inverse(), 0);
  }
  void show(LiveVision& vision, RigTime stamp, double turned_rad) { show(vision, stamp, image(turned_rad)); }
  static void show(LiveVision& vision, RigTime stamp, const test::VideoImage& image) {
    Chunk chunk{stamp, {}, 0, image.pixels};
    chunk.origin.frame.at_start = true;
    vision.take(chunk);
  }
  static void turn_at(LiveVision& vision, RigTime t, double rate_radps) {
    ImuSample sample;
    sample.t = sample.received = t;
    sample.gyro_radps = {0, rate_radps, 1e-6 * static_cast<double>(t.ns() % 1000)};
    sample.accel_mps2 = {0, 0, 9.81 + 1e-6 * static_cast<double>(t.ns() % 777)};
    vision.add(sample);
  }
  static std::size_t followed(const FeatureFrame& frame) {
    return static_cast<std::size_t>(
        std::ranges::count_if(frame.features(), [](const Feature& f) { return f.age > 0; }));
  }
  // How many features are followed over a turn of 0.4 rad, that is 170 pixels.
  std::size_t followed_over_a_turn(bool inertial) {
    const auto work = vision(inertial);
    const RigTime first = clock_.now() - Duration::from_seconds(1), second = first + Duration::from_seconds(kPeriod_s);
    constexpr double kRate_radps = 0.4 / kPeriod_s;
    for (int i = -20; inertial && i < 100; ++i) turn_at(*work, first + Duration::from_seconds(i * 1e-3), kRate_radps);
    show(*work, first, 0);
    work->turn();
    show(*work, second, 0.4);
    work->turn();
    EXPECT_TRUE(work->pop());
    const auto frame = work->pop();
    return frame ? followed(*frame) : 0;
  }

  HostClock clock_;
  LiveRig live_;
  Star star_;
  EventLog events_;
  std::optional<SensorWatch> watch_;
  test::TextureVideo video_;
};

TEST_F(LiveVisionWork, GivesFeaturesOfTheExposuresMiddleInOrder) {
  const auto work = vision(false);
  const RigTime first = clock_.now() - Duration::from_seconds(1);
  for (int i = 0; i < 3; ++i) {
    show(*work, first + Duration::from_seconds(i * kPeriod_s), 0.01 * i);
    work->turn();
  }
  for (int i = 0; i < 3; ++i) {
    const auto frame = work->pop();
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->stamp, first + Duration::from_seconds(i * kPeriod_s) + Duration::from_seconds(kExposure_s) / 2);
    EXPECT_GT(i == 0 ? frame->count : followed(*frame), 50U) << i;
  }
  EXPECT_FALSE(work->pop());
  EXPECT_TRUE(work->rejected().empty());
}

// Given a turn that is too fast to be followed by sight, then the gyroscope tells where features have gone.
TEST_F(LiveVisionWork, SeeksFeaturesWhereTheGyroscopeSays) {
  const std::size_t with = followed_over_a_turn(true), without = followed_over_a_turn(false);
  EXPECT_GT(with, 50U);
  EXPECT_LT(without, with / 2);
}

// Given somebody who knows places by images, then those whose features are handed over wait there, of the same
// instants.
TEST_F(LiveVisionWork, KeepsItsImagesForPlacesThatAreSeenAgain) {
  const auto work = vision(false);
  SightImages images(std::size_t{4} << 20U);
  work->keep_for_sight(images);
  show(*work, clock_.now() - Duration::from_seconds(1), 0);
  work->turn();
  const auto frame = work->pop();
  ASSERT_TRUE(frame);
  const auto kept = images.take(frame->stamp);
  ASSERT_TRUE(kept);
  const auto shown = image(0).pixels;  // but for the noise, which is drawn anew
  ASSERT_EQ(kept->data.size(), shown.size());
  double apart = 0;
  for (std::size_t i = 0; i < shown.size(); ++i) apart += std::abs(kept->data[i] - shown[i]);
  EXPECT_LT(apart / static_cast<double>(shown.size()), 4);
}

// Given an image that is here before the IMU's readings, then it waits for them, but not for an IMU that is silent.
TEST_F(LiveVisionWork, WaitsALittleForTheReadingsOfTheImu) {
  const auto work = vision(true);
  const test::VideoImage image = this->image(0);  // takes its time
  const RigTime now = clock_.now();
  turn_at(*work, now - Duration::from_seconds(0.1), 0);
  show(*work, now + Duration::from_seconds(0.2), image);  // stamped ahead: the machine may be slow
  work->turn();
  EXPECT_TRUE(work->waiting());
  EXPECT_FALSE(work->pop());
  turn_at(*work, now + Duration::from_seconds(0.21), 0);
  work->turn();
  EXPECT_TRUE(work->pop());
  show(*work, now - Duration::from_seconds(1), image);
  EXPECT_EQ(work->rejected().at("time_backwards"), 1U);
}

}  // namespace
}  // namespace lxd::board_live_vision_test
