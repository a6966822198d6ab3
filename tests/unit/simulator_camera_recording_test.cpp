// SPDX-License-Identifier: Apache-2.0
// A simulated camera's folder: its images, their times, and what faults do to them. Threads share the frames.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "drivers/replay/times_file.hpp"
#include "tests/support/camera_world.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/camera/camera_faults.hpp"
#include "tools/simulator/camera/write_camera.hpp"

namespace lxd::sim::simulator_camera_recording_test {
namespace {

using Eigen::Vector3d;

struct Studio {
  explicit Studio(std::vector<Fault> named = {}) : faults(std::move(named)) {
    config.resolution = {64, 48};
    config.intrinsics = {42, 42, 31.5, 23.5};
    config.T_body_sensor = test::forward_camera();
  }
  World world = test::checkerboard(4, 1, 6);
  Scene scene{world};
  Trajectory motion = test::steady_motion({0.1, 0.4, 0}, {0, 0, 0.1});
  FaultPlan faults;
  Context context{scene, motion, faults, 7, RigTime::from_ns(1'700'000'000'130'000'000), 2.0};
  CameraConfig config;
};

// Columns of frames.csv.
enum Column { kImage, kSequence, kBegin, kExposure, kGain, kReceived, kCorrupt };

std::vector<std::vector<std::string>> frames_csv(const std::filesystem::path& folder) {
  std::ifstream file(folder / "camera0" / "frames.csv");
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(file, line);) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  if (!rows.empty()) rows.erase(rows.begin());
  return rows;
}

std::string image(const std::filesystem::path& folder, const std::string& name) {
  return test::read_file(folder / "camera0" / name);
}

CameraLog written(const Studio& studio, const test::TemporaryFolder& folder) {
  const auto log = write_camera(studio.context, studio.config, folder.path());
  EXPECT_TRUE(log) << log.error().message;
  return log ? *log : CameraLog{};
}

Fault fault(std::string_view name, double begin_s, double end_s, double value = 0) {
  return {std::string(name), begin_s, end_s, value};
}

}  // namespace

TEST(SimulatorCameraRecording, GivenASyncedCameraThenItsFolderIsCompleteAndItsTimesAreTheTriggers) {
  Studio studio;
  studio.config.clock.latency_s = 0.02;
  const test::TemporaryFolder folder;
  const CameraLog log = written(studio, folder);
  // From 0.13 s into a second to 2.13 s: the triggers of 0.2 s to 2.0 s.
  ASSERT_EQ(log.delivered, 19U);
  EXPECT_EQ(log.triggered, 19U);
  const auto times = read_seconds_file(folder / "camera0/times.txt");
  ASSERT_TRUE(times) << times.error().message;
  const auto triggers = exposure_times(studio.context, studio.config);
  ASSERT_EQ(times->size(), triggers.size());
  const auto frames = frames_csv(folder.path());
  ASSERT_EQ(frames.size(), triggers.size());
  for (std::size_t i = 0; i < triggers.size(); ++i) {
    EXPECT_EQ(triggers[i].ns(), 1'700'000'000'200'000'000 + static_cast<std::int64_t>(i) * 100'000'000);
    EXPECT_EQ((*times)[i]->ns(), triggers[i].ns());
    EXPECT_EQ(frames[i][kSequence], std::to_string(i));
    const auto begin = parse_seconds(frames[i][kBegin]), received = parse_seconds(frames[i][kReceived]);
    const double exposure_s = parse_seconds(frames[i][kExposure])->seconds();
    EXPECT_EQ(begin, triggers[i]);
    EXPECT_NEAR((*received - *begin).seconds(), exposure_s + 0.02, 1e-8);
    EXPECT_FALSE(image(folder.path(), frames[i][kImage]).empty());
  }
}

TEST(SimulatorCameraRecording, GivenAFreeCameraThenItsOwnClockSaysWhen) {
  Studio studio;
  studio.config.trigger = CameraTrigger::kFree;
  studio.config.clock = {.offset_s = -1000, .skew_ppm = 500};
  const auto plan = plan_frames(studio.context, studio.config);
  ASSERT_TRUE(plan);
  const auto& frames = plan->frames;
  ASSERT_GE(frames.size(), 19U);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    EXPECT_NEAR(static_cast<double>(frames[i].stamp_ns - frames[i - 1].stamp_ns), 1e8, 2);
    EXPECT_NEAR(frames[i].begin_s - frames[i - 1].begin_s, 0.1 / 1.0005, 1e-9);
  }
  EXPECT_NEAR(static_cast<double>(frames[0].stamp_ns - studio.context.start.ns()) * 1e-9, frames[0].begin_s - 1000,
              1e-4);
  EXPECT_NE(std::fmod(frames[0].begin_s, 0.1), 0.07);
}

TEST(SimulatorCameraRecording, GivenAClockBeforeItsEpochThenTheScenarioIsRefused) {
  Studio studio;
  studio.config.clock.offset_s = -1.8e9;
  const auto plan = plan_frames(studio.context, studio.config);
  ASSERT_FALSE(plan);
  EXPECT_NE(plan.error().message.find("camera0: its clock's offset"), std::string::npos);
}

TEST(SimulatorCameraThreads, GivenTwoThreadsThenTheFolderHasTheSameBytesAsWithOne) {
  Studio studio({fault(kCameraCorrupt, 0.5, 1.0, 0.5), fault(kCameraDrop, 1.0, 1.5, 0.5)});
  studio.config.clock = {.jitter_s = 1e-4, .latency_s = 0.01, .latency_jitter_s = 0.005};
  const test::TemporaryFolder one, two;
  std::filesystem::create_directories(two / "b");
  ASSERT_TRUE(write_camera(studio.context, studio.config, one / "a", {.threads = 1}));
  ASSERT_TRUE(write_camera(studio.context, studio.config, two / "b", {.threads = 2}));
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(one / "a/camera0")) {
    const auto name = entry.path().filename();
    EXPECT_EQ(test::read_file(entry.path()), test::read_file(two / "b" / "camera0" / name)) << name;
    ++files;
  }
  EXPECT_GT(files, 15U);
}

TEST(SimulatorCameraRecording, GivenAnotherSeedThenTheImagesDiffer) {
  Studio studio;
  studio.context.duration_s = 0.3;
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_camera(studio.context, studio.config, folder / "a"));
  studio.context.seed = 8;
  ASSERT_TRUE(write_camera(studio.context, studio.config, folder / "b"));
  EXPECT_NE(image(folder / "a", "000000.png"), image(folder / "b", "000000.png"));
}

TEST(SimulatorCameraRecording, GivenDroppedFramesThenTheSequenceHasGaps) {
  const Studio studio({fault(kCameraDrop, 0.5, 1.5, 0.6)});
  const test::TemporaryFolder folder;
  const CameraLog log = written(studio, folder);
  const auto frames = frames_csv(folder.path());
  EXPECT_GT(log.dropped, 1U);
  EXPECT_LT(log.dropped, 10U);
  EXPECT_EQ(log.delivered + log.dropped, log.triggered);
  EXPECT_EQ(frames.size(), log.delivered);
  EXPECT_EQ(frames.back()[kSequence], std::to_string(log.triggered - 1));
  EXPECT_EQ(exposure_times(studio.context, studio.config).size(), log.triggered)
      << "the line is triggered all the same";
}

TEST(SimulatorCameraRecording, GivenAPulledCableThenThereAreNoFramesAndTheSequenceBeginsAgain) {
  const Studio studio({fault(kCameraUnplugged, 0.5, 1.5)});
  const test::TemporaryFolder folder;
  const CameraLog log = written(studio, folder);
  EXPECT_EQ(log.unplugged, 10U);
  EXPECT_EQ(log.delivered + log.unplugged, log.triggered);
  int restarts = 0;
  for (const auto& frame : frames_csv(folder.path())) {
    const double t_s = (*parse_seconds(frame[kBegin]) - studio.context.start).seconds();
    EXPECT_TRUE(t_s < 0.5 || t_s >= 1.5) << t_s;
    if (frame[kSequence] == "0") ++restarts;
  }
  EXPECT_EQ(restarts, 2);
}

TEST(SimulatorCameraRecording, GivenCorruptFramesThenTheyAreFlaggedAndOnlyTheyDiffer) {
  const Studio sound, broken({fault(kCameraCorrupt, 0.5, 1.5, 0.5)});
  const test::TemporaryFolder folder;
  ASSERT_TRUE(write_camera(sound.context, sound.config, folder / "sound"));
  const auto log = write_camera(broken.context, broken.config, folder / "broken");
  ASSERT_TRUE(log);
  EXPECT_GT(log->corrupt, 1U);
  EXPECT_LT(log->corrupt, 10U);
  std::uint64_t flagged = 0;
  for (const auto& frame : frames_csv(folder / "broken")) {
    const bool corrupt = frame[kCorrupt] == "1";
    if (corrupt) ++flagged;
    EXPECT_EQ(image(folder / "sound", frame[kImage]) != image(folder / "broken", frame[kImage]), corrupt);
  }
  EXPECT_EQ(flagged, log->corrupt);
}

TEST(SimulatorCameraRecording, GivenAnExposureJumpThenTheExposureIsSoManyTimesAsLong) {
  const Studio sound, jumping({fault(kCameraExposureJump, 0.5, 1.5, 3)});
  const auto plain = plan_frames(sound.context, sound.config), jumped = plan_frames(jumping.context, jumping.config);
  ASSERT_TRUE(plain && jumped);
  EXPECT_EQ(jumped->log.jumped, 10U);
  for (std::size_t i = 0; i < plain->frames.size(); ++i) {
    const Frame &a = plain->frames[i], &b = jumped->frames[i];
    const double factor = a.begin_s >= 0.5 && a.begin_s < 1.5 ? 3 : 1;
    EXPECT_NEAR(b.exposure.duration_s * b.exposure.gain, factor * a.exposure.duration_s * a.exposure.gain, 1e-12);
    EXPECT_LE(b.exposure.duration_s, CameraConfig::kLongestExposure / jumping.config.rate_hz);
  }
}

TEST(SimulatorCameraRecording, GivenLowLightThenTheControlExposesLongerAndAddsGain) {
  Studio day, night, fixed;
  night.config.low_light = true;
  fixed.config.auto_exposure = false;
  const auto bright = plan_frames(day.context, day.config), dim = plan_frames(night.context, night.config),
             steady = plan_frames(fixed.context, fixed.config);
  ASSERT_TRUE(bright && dim && steady);
  EXPECT_LT(bright->frames[5].exposure.duration_s, day.config.exposure_max_s);
  EXPECT_EQ(bright->frames[5].exposure.gain, 1);
  EXPECT_EQ(dim->frames[5].exposure.duration_s, night.config.exposure_max_s);
  EXPECT_GT(dim->frames[5].exposure.gain, 4);
  for (const Frame& frame : steady->frames) EXPECT_EQ(frame.exposure.duration_s, fixed.config.exposure_s);
}

TEST(SimulatorCameraRecording, GivenAFolderThatCannotBeWrittenThenTheErrorNamesTheFile) {
  const Studio studio;
  const test::TemporaryFolder folder;
  test::write_file(folder / "blocked", "a file, no folder");
  const auto no_folder = write_camera(studio.context, studio.config, folder / "blocked");
  ASSERT_FALSE(no_folder);
  EXPECT_NE(no_folder.error().message.find("blocked/camera0"), std::string::npos);
  for (const char* name : {"camera0/000003.png", "camera0/times.txt", "camera0/frames.csv"}) {
    const auto recording = folder / "recording";
    std::filesystem::remove_all(recording);
    std::filesystem::create_directories(recording / name);  // a folder where a file should be
    const auto blocked = write_camera(studio.context, studio.config, recording, {.threads = 2});
    ASSERT_FALSE(blocked) << name;
    EXPECT_NE(blocked.error().message.find(name), std::string::npos) << blocked.error().message;
  }
}

TEST(SimulatorCameraFaults, GivenTheListThenEachHasItsDefaults) {
  ASSERT_EQ(camera_faults().size(), 4U);
  for (const KnownFault& known : camera_faults()) {
    EXPECT_TRUE(known.name.starts_with("camera_"));
    EXPECT_FALSE(known.what.empty());
    EXPECT_GT(known.duration_s, 0);
  }
}

}  // namespace lxd::sim::simulator_camera_recording_test
