// SPDX-License-Identifier: Apache-2.0
// `record` with a camera, its triggers and a pulse, from a made kernel: all that was sent is in the recording, through
// a camera that is pulled out and put in again.
#include <chrono>
#include <thread>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "board/camera_stream.hpp"
#include "board/recorder.hpp"
#include "board/rig_file.hpp"
#include "drivers/replay/pps_log.hpp"
#include "tests/support/loopback.hpp"
#include "tests/support/made_board.hpp"
#include "tests/support/temporary_folder.hpp"

namespace lxd::board_live_signals_test {
namespace {

using std::chrono::milliseconds;

constexpr std::uint32_t kWidth = 16, kHeight = 8;

std::int64_t monotonic_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

class LiveSignals : public testing::Test {
 protected:
  LiveSignals() {
    test::write_file(folder_ / "rig.yaml",
                     fmt::format("lidar0: {{model: livox, port: {}}}\n"
                                 "camera0: {{resolution: [{}, {}], intrinsics: [20, 20, 8, 4], device: /dev/video7, "
                                 "pixel_format: grey, stamp: trigger, exposure_s: 0.002, rate_hz: 20}}\n"
                                 "pps: {{device: /dev/pps0}}\ntriggers: {{chip: gpiochip0, camera0: 5}}\n",
                                 test::free_udp_port(), kWidth, kHeight));
    auto opened = Recorder::open({folder_ / "rig.yaml", recording_, {}, board_.kernel()});
    EXPECT_TRUE(opened) << opened.error().message;
    recorder_ = std::move(*opened);
    run_ = std::thread([this] { done_ = recorder_->run([](const RecordProgress&) {}, stop_); });
    for (int i = 0; i < 200 && !board_.streaming(); ++i) std::this_thread::sleep_for(milliseconds(10));
    EXPECT_TRUE(board_.streaming());
  }
  ~LiveSignals() override { stop(); }

  void stop() {
    std::this_thread::sleep_for(milliseconds(100));
    stop_ = true;
    if (run_.joinable()) run_.join();
  }

  // An edge, and a frame whose stamp is 8 ms later, however long a busy machine sleeps; its first pixel is its number.
  void expose(int i) {
    const std::int64_t edge_ns = monotonic_ns();
    edges_.push_back(edge_ns);
    board_.edge(edge_ns, true);
    const std::int64_t frame_ns = edge_ns + 8'000'000;
    std::this_thread::sleep_for(milliseconds(8));
    board_.edge(frame_ns, false);
    std::string pixels(kWidth * kHeight, 'x');
    pixels[0] = static_cast<char>(i);
    board_.send({.sequence = static_cast<std::uint32_t>(i), .stamp_us = frame_ns / 1000, .content = pixels});
    std::this_thread::sleep_for(milliseconds(25));
  }

  [[nodiscard]] nlohmann::json summary() const {
    return nlohmann::json::parse(test::read_file(recording_ / kRecordingFile));
  }
  [[nodiscard]] bool tells(const std::string& source, const std::string& what) const {
    const nlohmann::json all = summary();
    for (const auto& event : all["events"])
      if (event["source"] == source && event["what"].get<std::string>().starts_with(what)) return true;
    return false;
  }
  [[nodiscard]] std::vector<CameraImage> images() const {
    const RigFile rig = load_rig((recording_ / "rig.yaml").string());
    EXPECT_TRUE(rig.ok()) << text_of(rig.problems);
    auto camera = open_timed_camera(recording_, rig.rig);
    EXPECT_TRUE(camera) << camera.error().message;
    std::vector<CameraImage> all;
    for (CameraImage image; camera && camera->next(image);) all.push_back(image);
    return all;
  }

  test::TemporaryFolder folder_;
  std::filesystem::path recording_ = folder_ / "recording";
  test::MadeBoard board_{kWidth * kHeight};
  std::unique_ptr<Recorder> recorder_;
  std::atomic<bool> stop_{false};
  Status done_ = success();
  std::thread run_;
  std::vector<std::int64_t> edges_;
};

// Given frames 8 ms behind the edges that triggered them, when they are recorded, then a replay of the recording gives
// every image, of the instant of its edge, half of the exposure later; and the pulses are there.
TEST_F(LiveSignals, AreRecordedAndReplayed) {
  const HostClock clock;
  for (int i = 0; i < 30; ++i) {
    if (i % 10 == 5) board_.pulse(clock.now());
    expose(i);
  }
  stop();
  ASSERT_TRUE(done_) << done_.error().message;
  const auto found = images();
  ASSERT_EQ(found.size(), edges_.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].pixels.data[0], i);
    EXPECT_EQ((found[i].instant - found[0].instant).ns(), edges_[i] - edges_[0]) << i;
  }
  const auto pulses = read_pps_log(recording_ / kPpsLogFile);
  ASSERT_TRUE(pulses) << pulses.error().message;
  EXPECT_EQ(pulses->edges.size(), 3U);
  const auto sensors = summary()["sensors"];
  EXPECT_EQ(sensors["camera0"]["chunks"], 30);
  EXPECT_EQ(sensors["camera0"]["no_room"], 0);
  EXPECT_EQ(sensors["triggers"]["chunks"], 60);
  EXPECT_TRUE(tells("camera0", "heard"));
  EXPECT_TRUE(tells("triggers", "heard"));
  EXPECT_TRUE(tells("pps", "heard"));
}

// Given a camera that is pulled out and put in again, then both are events, and what came before and after is there.
TEST_F(LiveSignals, SurviveACameraThatIsPulledOut) {
  for (int i = 0; i < 8; ++i) expose(i);
  board_.plug_camera(false);
  std::this_thread::sleep_for(milliseconds(400));
  board_.plug_camera(true);
  for (int i = 0; i < 300 && !board_.streaming(); ++i) std::this_thread::sleep_for(milliseconds(10));
  std::this_thread::sleep_for(milliseconds(700));  // it is sought at growing intervals
  for (int i = 0; i < 8; ++i) expose(i);
  stop();
  ASSERT_TRUE(done_) << done_.error().message;
  EXPECT_EQ(images().size(), 16U);
  EXPECT_TRUE(tells("/dev/video7", "away: /dev/video7: No such device"));
  EXPECT_TRUE(tells("/dev/video7", "back"));
  EXPECT_TRUE(tells("camera0", "silent"));
  EXPECT_TRUE(tells("camera0", "heard again"));
  EXPECT_EQ(summary()["devices"]["/dev/video7"]["departure"], 1);
}

}  // namespace
}  // namespace lxd::board_live_signals_test
