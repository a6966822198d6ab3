// SPDX-License-Identifier: Apache-2.0
// A V4L2 camera: set up as wanted or refused in words, stamped frames, gaps and damage counted, pulled out and back.
// With a made kernel; and with the real one where a camera is (the kernel's own `vivid` is one).
#include <gtest/gtest.h>
#include <poll.h>

#include "drivers/camera/v4l2_camera.hpp"
#include "drivers/camera/video_controls.hpp"
#include "tests/support/made_camera.hpp"

namespace lxd::drivers_v4l2_camera_test {
namespace {

using test::MadeCamera;

class Frames final : public ChunkSink {
 public:
  void take(const Chunk& chunk) override {
    contents.emplace_back(chunk.bytes.begin(), chunk.bytes.end());
    stamps.push_back(chunk.received);
  }
  std::vector<std::string> contents;
  std::vector<RigTime> stamps;
};

class V4l2 : public testing::Test {
 protected:
  static VideoConfig wanted() {
    return {.path = "/dev/video7", .fourcc = V4L2_PIX_FMT_GREY, .width = 8, .height = 4, .rate_hz = 25};
  }
  void tend() { camera_.tend(now_ = now_ + Duration::from_seconds(3)); }
  // Why it does not open.
  std::string refusal(const VideoConfig& config) {
    V4l2Camera camera(config, 0, clock_, kernel_);
    camera.tend(RigTime::from_ns(0));
    EXPECT_EQ(camera.fd(), -1);
    EXPECT_EQ(kernel_.open_files, 0);
    EXPECT_EQ(kernel_.mapped, 0);
    return camera.trouble();
  }

  HostClock clock_;
  MadeCamera kernel_;
  V4l2Camera camera_{wanted(), 3, clock_, kernel_};
  Frames frames_;
  RigTime now_ = RigTime::from_ns(0);
};

TEST_F(V4l2, OpensStreamsAndDeliversFramesWithTheirStamps) {
  tend();
  ASSERT_TRUE(camera_.trouble().empty()) << camera_.trouble();
  EXPECT_TRUE(kernel_.streaming);
  EXPECT_DOUBLE_EQ(kernel_.rate_hz, 25);
  EXPECT_EQ(camera_.fd(), MadeCamera::kFd);
  EXPECT_EQ(camera_.layout()->width, 8U);
  kernel_.send({.sequence = 0, .stamp_us = 5'000'001, .content = "one"});
  kernel_.send({.sequence = 1, .stamp_us = 5'040'001, .flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC, .content = "two"});
  camera_.read(frames_);
  EXPECT_EQ(frames_.contents, (std::vector<std::string>{"one", "two"}));
  EXPECT_EQ(frames_.stamps[0], clock_.of_monotonic(5'000'001'000));
  EXPECT_EQ(camera_.frame().instant, FrameInstant::end_of_frame) << "of the last one";
  EXPECT_EQ(kernel_.queued, 4) << "every buffer is given back";
  EXPECT_EQ(camera_.camera_counts().frames, 2U);
}

TEST_F(V4l2, KnowsFramesThatAreStampedAtTheStartOfExposure) {
  tend();
  kernel_.send({.sequence = 0});
  camera_.read(frames_);
  EXPECT_EQ(camera_.frame().instant, FrameInstant::start_of_exposure);
}

TEST_F(V4l2, CountsWhatIsLostCorruptOrStampedByAnotherClock) {
  tend();
  kernel_.send({.sequence = 10});
  kernel_.send({.sequence = 14});
  kernel_.send({.sequence = 15, .flags = V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC | V4L2_BUF_FLAG_ERROR});
  kernel_.send({.sequence = 16, .flags = V4L2_BUF_FLAG_TIMESTAMP_UNKNOWN});
  kernel_.send({.sequence = 17, .flags = V4L2_BUF_FLAG_TIMESTAMP_COPY});
  kernel_.send({.sequence = 18, .bytesused = 65});  // the buffer has 64
  kernel_.send({.sequence = 2});                    // the count begins anew
  camera_.read(frames_);
  EXPECT_EQ(frames_.contents.size(), 3U);
  EXPECT_EQ(camera_.camera_counts().lost, 3U);
  EXPECT_EQ(camera_.camera_counts().corrupt, 1U);
  EXPECT_EQ(camera_.camera_counts().other_clock, 2U);
  EXPECT_EQ(camera_.camera_counts().empty, 1U);
  EXPECT_EQ(kernel_.queued, 4);
}

TEST_F(V4l2, IsFoundAgainAfterItWasPulledOut) {
  tend();
  kernel_.send({.sequence = 0});
  camera_.read(frames_);
  kernel_.present = false;
  camera_.read(frames_);
  EXPECT_EQ(camera_.fd(), -1);
  EXPECT_EQ(kernel_.mapped, 0) << "nothing of it stays mapped";
  EXPECT_EQ(camera_.trouble(), "/dev/video7: No such device");
  tend();
  EXPECT_EQ(camera_.trouble(), "/dev/video7: cannot be opened: No such file or directory");
  kernel_.present = true;
  tend();
  kernel_.send({.sequence = 0});
  camera_.read(frames_);
  EXPECT_EQ(frames_.contents.size(), 2U);
  EXPECT_EQ(camera_.counts().departures, 1U);
  EXPECT_EQ(camera_.counts().openings, 2U);
  EXPECT_EQ(camera_.camera_counts().lost, 0U);
}

TEST_F(V4l2, BearsASignalThatIsLostForAMoment) {
  tend();
  kernel_.fails_with = EIO;
  camera_.read(frames_);
  kernel_.send({.sequence = 0});
  camera_.read(frames_);
  EXPECT_EQ(frames_.contents.size(), 1U);
  EXPECT_EQ(camera_.counts().read_errors, 1U);
  EXPECT_EQ(camera_.counts().departures, 0U);
}

TEST_F(V4l2, SetsExposureAndControlsByName) {
  VideoConfig config = wanted();
  config.exposure_s = 5e-3;
  config.controls = {{"trigger_mode", 1}, {"gain", 7}};
  V4l2Camera camera(config, 0, clock_, kernel_);
  camera.tend(RigTime::from_ns(0));
  ASSERT_TRUE(camera.trouble().empty()) << camera.trouble();
  EXPECT_EQ(kernel_.controls[V4L2_CID_EXPOSURE_AUTO], V4L2_EXPOSURE_MANUAL);
  EXPECT_EQ(kernel_.controls[V4L2_CID_EXPOSURE_ABSOLUTE], 50);
  EXPECT_EQ(kernel_.controls[MadeCamera::kTriggerMode], 1);
  EXPECT_EQ(kernel_.controls[V4L2_CID_GAIN], 7);
}

TEST_F(V4l2, SaysWhatItIsRefused) {
  VideoConfig config = wanted();
  config.controls = {{"trigger", 1}};
  EXPECT_EQ(refusal(config), "/dev/video7: found no control trigger, wanted one of: gain, trigger_mode");
  config.controls = {{"trigger_mode", 2}};
  EXPECT_EQ(refusal(config), "/dev/video7: control trigger_mode = 2: Numerical result out of range");
  kernel_.most_buffers = 1;
  EXPECT_EQ(refusal(wanted()), "/dev/video7: found 1 buffers, wanted at least 2");
  kernel_.only_fourcc = V4L2_PIX_FMT_YUYV;
  EXPECT_EQ(refusal(wanted()), "/dev/video7: found YUYV of 8 x 4 pixels, wanted GREY of 8 x 4");
  kernel_.abilities = V4L2_CAP_VIDEO_OUTPUT | V4L2_CAP_STREAMING;
  EXPECT_NE(refusal(wanted()).find("wanted capture and streaming"), std::string::npos);
}

TEST(VideoControls, AreNamedAsTheToolsDo) {
  EXPECT_EQ(plain_control_name("Trigger Mode"), "trigger_mode");
  EXPECT_EQ(plain_control_name("White Balance, Auto & Preset"), "white_balance_auto_preset");
  EXPECT_EQ(plain_control_name("Exposure (Absolute)"), "exposure_absolute");
}

// The real kernel's, where there is a camera that sends YUYV of 640 x 480 pixels.
TEST(V4l2RealKernel, FramesArriveInOrderWithPresentStamps) {
  const HostClock clock;
  V4l2Camera camera({.path = "/dev/video0", .fourcc = V4L2_PIX_FMT_YUYV, .width = 640, .height = 480, .rate_hz = 25}, 0,
                    clock);
  camera.tend(clock.now());
  if (camera.fd() < 0) GTEST_SKIP() << camera.trouble();
  Frames frames;
  const RigTime begin = clock.now();
  for (int i = 0; i < 100 && frames.stamps.size() < 3; ++i) {
    pollfd ready{camera.fd(), POLLIN, 0};
    ::poll(&ready, 1, 100);
    camera.read(frames);
  }
  ASSERT_GE(frames.stamps.size(), 3U);
  EXPECT_LT(frames.stamps[1], frames.stamps[2]);
  EXPECT_GT(frames.stamps[2], begin);
  EXPECT_LE(frames.stamps[2], clock.now());
  EXPECT_EQ(frames.contents[0].size(), 640U * 480U * 2U);
}

}  // namespace
}  // namespace lxd::drivers_v4l2_camera_test
