// SPDX-License-Identifier: Apache-2.0
// What cannot be simulated is told before work begins, by file, line and key, and leaves nothing; what fails on the way
// leaves nothing that looks like a recording.
#include <csignal>

#include "tests/support/replay_files.hpp"
#include "tests/support/run_result.hpp"

namespace lxd::test::simulate_refusal_test {
namespace {

namespace fs = std::filesystem;

constexpr int kFailed = 1, kBadInput = 2;
constexpr const char* kWalk =
    "world: building\nmotion: {carrier: handheld}\nduration_s: 2\n"
    "lidar0: {model: ouster, product: OS0, beams: 16, columns: 512}\n";

class RefusedSimulation : public testing::Test {
 protected:
  Ended simulate(const std::string& scenario, const std::string& options = "", const ProgramLimits& limits = {}) {
    return lxd_slam(fmt::format("simulate {} {} --out {}", scenario, options, out().string()), limits);
  }
  std::string scenario_file(const std::string& text) {
    write_file(folder_ / "rig.scenario", text);
    return (folder_ / "rig.scenario").string();
  }
  void expect_refused(const Ended& ended, const std::vector<std::string>& said) {
    EXPECT_EQ(ended.status, kBadInput) << ended.text;
    for (const std::string& part : said) EXPECT_TRUE(ended.says(part)) << "wanted: " << part << "\n" << ended.text;
    expect_nothing_left();
  }
  void expect_nothing_left() {
    EXPECT_FALSE(fs::exists(out()));
    EXPECT_TRUE(parts().empty());
  }
  // Folders of recordings under way.
  [[nodiscard]] std::vector<fs::path> parts() const {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder_.path())) {
      if (entry.path().filename().string().starts_with("recording.part")) found.push_back(entry.path());
    }
    return found;
  }
  [[nodiscard]] fs::path out() const { return folder_ / "recording"; }

  TemporaryFolder folder_;
};

TEST_F(RefusedSimulation, UnknownScenarioNamesTheNearestAndAll) {
  expect_refused(simulate("handheld_rom"), {"no such scenario", "did you mean handheld_room", "street_loop"});
}

TEST_F(RefusedSimulation, UnknownSensorAndKeyAreNamedAtOnceWithTheirLines) {
  const std::string text = std::string(kWalk) + "radar0: {}\nimu: {update_rte: 200}\n";
  expect_refused(simulate(scenario_file(text)),
                 {":5: radar0: unknown key", ":6: imu.update_rte", "did you mean update_rate"});
}

TEST_F(RefusedSimulation, UnknownWorldCarrierAndRouteAreNamed) {
  const auto with = [&](const std::string& world, const std::string& motion) {
    return simulate(scenario_file("world: " + world + "\nmotion: " + motion + "\nlidar0: {model: livox}\n"));
  };
  expect_refused(with("castle", "{carrier: handheld}"), {"castle", "building"});
  expect_refused(with("building", "{carrier: horse}"), {"motion.carrier", "horse", "legged"});
  expect_refused(with("building", "{carrier: handheld, route: roof}"), {"roof", "walk"});
}

TEST_F(RefusedSimulation, UnknownFaultAndOneOfAnAbsentSensorAreNamed) {
  expect_refused(simulate(scenario_file(kWalk), "--fault lidar0_los --fault imu_gap"),
                 {"did you mean lidar0_loss", "imu_gap"});
}

TEST_F(RefusedSimulation, DurationOfZeroIsRefused) {
  expect_refused(simulate(scenario_file(kWalk), "--duration 0"), {"duration"});
  expect_refused(simulate(scenario_file(kWalk), "--duration nan"), {"duration"});
  expect_refused(simulate(scenario_file(kWalk), "--duration 0.05"), {"0.05"});
  expect_refused(
      simulate(scenario_file("world: building\nmotion: {carrier: handheld}\nduration_s: 0\nlidar0: {model: livox}\n")),
      {"duration_s"});
}

TEST_F(RefusedSimulation, PathThroughAWallIsToldWithTimeAndPlace) {
  std::string path;
  for (int i = 0; i <= 100; ++i) path += fmt::format("{:.1f} {:.2f} 0 0 0 0 0 1\n", 0.1 * i, 1.0 * i);
  write_file(folder_ / "path.tum", path);
  const std::string motion = fmt::format("{{carrier: path, file: {}}}", (folder_ / "path.tum").string());
  expect_refused(
      simulate(scenario_file("world: building\nmotion: " + motion + "\nduration_s: 4\nlidar0: {model: livox}\n")),
      {"motion: at", "the body", "wanted a way through free space"});
}

// Given a body whose way is free, when a sensor on it is above the ceiling, beside the world or behind a wall at times,
// then it is told which one, when and where.
TEST_F(RefusedSimulation, SensorThatSticksIntoAWallIsToldWithTimeAndPlace) {
  const auto mounted = [](const char* sensor, const char* rest, double x, double z) {
    return fmt::format("{}: {{{}T_body_sensor: [[1, 0, 0, {}], [0, 1, 0, 0], [0, 0, 1, {}], [0, 0, 0, 1]]}}\n", sensor,
                       rest, x, z);
  };
  const std::string walk = "world: building\nmotion: {carrier: handheld}\nduration_s: 20\n";
  const std::string livox = "lidar0: {model: livox}\n";
  const std::string lidar = "model: livox, ";
  expect_refused(simulate(scenario_file(walk + mounted("lidar0", lidar.c_str(), 0, 3.5))),
                 {"lidar0: at 0.00 s", "seen from the body", "wanted it in free space"});
  expect_refused(simulate(scenario_file(walk + livox + mounted("lidar1", lidar.c_str(), 3, 0))),
                 {"lidar1: at ", "the sensor is"});
  expect_refused(simulate(scenario_file(walk + livox + mounted("camera0", "", 0, -3))), {"camera0: at 0.00 s"});
  expect_refused(simulate(scenario_file(walk + livox + "gnss: {antenna_in_reference_m: [0, 0, 80]}\n")),
                 {"gnss: at 0.00 s"});
}

TEST_F(RefusedSimulation, FaultsThatOverlapOrSetAClockBeforeItsZeroAreTold) {
  expect_refused(simulate(scenario_file(kWalk), "--fault lidar0_off@0.5+1 --fault lidar0_off@1+1"),
                 {"lidar0_off@0.5+1", "lidar0_off@1+1", "overlap"});
  expect_refused(simulate(scenario_file(kWalk), "--fault lidar0_time_step@1=-62"),
                 {"lidar0: clock: found a stamp of -", "at 1 s"});
}

TEST_F(RefusedSimulation, SerialLineTooSlowForItsSentencesIsTold) {
  expect_refused(simulate(scenario_file(std::string(kWalk) + "gnss: {rate_hz: 20, baud_rate: 9600}\n")),
                 {"gnss: found a baud_rate of 9600, wanted at least"});
}

TEST_F(RefusedSimulation, PathWithTooFewPosesNamesTheFile) {
  write_file(folder_ / "path.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  const std::string motion = fmt::format("{{carrier: path, file: {}}}", (folder_ / "path.tum").string());
  expect_refused(
      simulate(scenario_file("world: field\nmotion: " + motion + "\nduration_s: 4\nlidar0: {model: livox}\n")),
      {"path.tum", "poses"});
}

TEST_F(RefusedSimulation, FolderOfSomethingElseStaysAsItIs) {
  fs::create_directories(out());
  write_file(out() / "thesis.tex", "x");
  const Ended ended = simulate(scenario_file(kWalk));
  EXPECT_EQ(ended.status, kBadInput);
  EXPECT_TRUE(ended.says("holds something else")) << ended.text;
  EXPECT_EQ(read_file(out() / "thesis.tex"), "x");
}

// The limit on a file's size stands in for a full disk.
TEST_F(RefusedSimulation, FullDiskFailsAndLeavesNoRecording) {
  const Ended ended = simulate(scenario_file(kWalk), "", {.file_bytes = 2'000'000});
  EXPECT_EQ(ended.status, kFailed) << ended.text;
  EXPECT_TRUE(ended.says("lidar0.pcap: cannot be written: File too large")) << ended.text;
  expect_nothing_left();
}

TEST_F(RefusedSimulation, InterruptLeavesNoRecording) {
  Program program(fmt::format("simulate handheld_room --out {}", out().string()));
  while (parts().empty() || !fs::exists(parts().front() / "lidar0.pcap")) usleep(10'000);
  program.signal(SIGINT);
  const Ended ended = program.wait();
  EXPECT_EQ(ended.status, kFailed) << ended.text;
  expect_nothing_left();
}

// Given a LiDAR that was off for the whole recording, when it is replayed, then it is not taken for a foreign file.
TEST_F(RefusedSimulation, RecordingWithoutAPacketOfTheLidarIsSaidToBeThat) {
  const std::string rig = "world: field\nmotion: {carrier: wheeled}\nduration_s: 1\nlidar0: {model: livox}\n";
  ASSERT_EQ(simulate(scenario_file(rig), "--fault lidar0_off@0+60").status, 0);
  const Ended ended = lxd_slam(fmt::format("replay {} --out {}", out().string(), (folder_ / "run").string()));
  EXPECT_EQ(ended.status, kBadInput) << ended.text;
  EXPECT_TRUE(ended.says("lidar0.pcap: found no packet at all")) << ended.text;
}

class SimulationByItsNameAlone : public RefusedSimulation {};

TEST_F(SimulationByItsNameAlone, SaysWhatItWroteAndWhatComesNext) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_.path());
  const Ended ended = lxd_slam("simulate handheld_room --duration 0.5");
  fs::current_path(before);
  EXPECT_EQ(ended.status, 0) << ended.text;
  for (const char* const part : {"handheld_room: 0.5 s along", "camera0/", "lidar0.pcap", "truth.tum", "world.ply",
                                 "next: lxd-slam replay handheld_room --out run", "lxd-slam evaluate --estimate"})
    EXPECT_TRUE(ended.says(part)) << part << " in\n" << ended.text;
  EXPECT_TRUE(fs::exists(folder_ / "handheld_room" / "lidar0.pcap"));
}

// Given a simulation that was killed, which can clean up nothing, when what it left is replayed under another name,
// then every word about it says that it is not whole.
TEST_F(RefusedSimulation, WhatAKilledOneLeavesDoesNotLookWhole) {
  Program program(fmt::format("simulate {} --duration 60 --out {}", scenario_file(kWalk), out().string()));
  const auto capture_bytes = [&]() -> std::uintmax_t {
    std::error_code none;
    const auto bytes = parts().empty() ? 0 : fs::file_size(parts().front() / "lidar0.pcap", none);
    return none ? 0 : bytes;
  };
  while (capture_bytes() < 3'000'000) usleep(10'000);
  program.signal(SIGKILL);
  (void)program.wait();
  ASSERT_FALSE(parts().empty());
  fs::rename(parts().front(), out());

  const Ended ended = lxd_slam(fmt::format("replay {} --out {}", out().string(), (folder_ / "run").string()));
  EXPECT_EQ(ended.status, 0) << ended.text;
  EXPECT_TRUE(ended.says("the recording was not finished")) << ended.text;
  EXPECT_TRUE(ended.says(out().string())) << ended.text;
  const auto report = nlohmann::json::parse(read_file(folder_ / "run" / "report.json"));
  EXPECT_EQ(report["rejected"]["rig-recording"]["unfinished_recording"], 1);
}

}  // namespace
}  // namespace lxd::test::simulate_refusal_test
