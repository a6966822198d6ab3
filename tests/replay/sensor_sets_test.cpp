// SPDX-License-Identifier: Apache-2.0
// Simulated recordings replayed with one LiDAR or two, camera, IMU and wheels, through the program.
#include <array>
#include <set>
#include <string>

#include "tests/support/replay_files.hpp"
#include "tests/support/run_result.hpp"

namespace lxd::test::sensor_sets_test {
namespace {

namespace fs = std::filesystem;

// A robot on wheels in a car park, from rest to driving; small sensors, so that the whole way is short.
constexpr const char* kRobot = R"yaml(
world: parking
motion: {carrier: wheeled, rest_s: 0.5}
duration_s: 6
lidar0: {model: ouster, product: OS0, beams: 32, columns: 512}
imu: {protocol: vectornav, update_rate: 200}
wheel: {protocol: agilex}
lidar1: {model: livox, T_body_sensor: [[1, 0, 0, 0.2], [0, 1, 0, 0], [0, 0, 1, 0.1], [0, 0, 0, 1]]}
camera0:
  resolution: [320, 240]
  intrinsics: [210, 210, 159.5, 119.5]
  T_body_sensor: [[0, 0, 1, 0.3], [-1, 0, 0, 0.0], [0, -1, 0, 0.2], [0, 0, 0, 1]]
)yaml";

struct SensorsAndError {
  const char* sensors;
  double ate_m;
};
constexpr std::array<SensorsAndError, 8> kSets{{{"L", 0.012},
                                                {"LI", 0.006},
                                                {"LW", 0.008},
                                                {"LIW", 0.006},
                                                {"LL", 0.012},
                                                {"LC", 0.012},
                                                {"LCI", 0.006},
                                                {"LLCIW", 0.006}}};
constexpr std::array kResults{
    "odometry.tum", "odometry_covariance.txt", "odometry_innovation.txt", "trajectory.tum", "mesh.ply", "cloud.ply"};

class SensorSets : public testing::Test {
 protected:
  fs::path simulated(const std::string& options = "", const char* scenario = kRobot) {
    write_file(folder_ / "scenario.yaml", scenario);
    const Ended ended = lxd_slam(fmt::format("simulate {} {} --out {}", (folder_ / "scenario.yaml").string(), options,
                                             (folder_ / "recording").string()));
    EXPECT_EQ(ended.status, 0) << ended.text;
    return folder_ / "recording";
  }
  double ate_m(const fs::path& recording, const RunResult& run) {
    const auto report = evaluated(
        fmt::format("--estimate {} --truth {}", (run / "odometry.tum").string(), (recording / "truth.tum").string()));
    return report["ate_m"]["rmse"];
  }
  TemporaryFolder folder_;
};

// Each is a path of its own: the sensors are used.
TEST_F(SensorSets, EveryOneOfThemFollowsARobotWithoutAllocating) {
  const fs::path recording = simulated();
  std::set<std::string> paths;
  for (const auto& [sensors, ate_max_m] : kSets) {
    const RunResult run = replayed(recording, folder_, std::string("--sensors ") + sensors, sensors);
    EXPECT_LT(ate_m(recording, run), ate_max_m) << sensors;
    EXPECT_EQ(run.path().size(), 60U) << sensors;
    EXPECT_TRUE(paths.insert(run.bytes("odometry.tum")).second) << sensors;
    const auto report = run.report();
    if (!report["rt_allocations"].is_null()) {
      EXPECT_EQ(report["rt_allocations"], 0) << sensors;
    }
  }
}

TEST_F(SensorSets, ReadInTurnOrAheadTheyGiveTheSameBytes) {
  const fs::path recording = simulated();
  const std::string options = "--set threads=";  // with every sensor
  const RunResult one = replayed(recording, folder_, options + "1", "one");
  for (const char* const threads : {"1", "2"}) {
    const RunResult other = replayed(recording, folder_, options + threads, std::string("again") + threads);
    for (const char* const name : kResults) {
      EXPECT_FALSE(one.bytes(name).empty()) << name;
      EXPECT_TRUE(one.bytes(name) == other.bytes(name)) << name << " " << threads;
    }
  }
}

TEST_F(SensorSets, AGenericFoldersTextsAreAsGood) {
  const fs::path recording = simulated("--generic");
  ASSERT_TRUE(fs::exists(recording / "imu.csv"));
  ASSERT_TRUE(fs::exists(recording / "wheel.csv"));
  EXPECT_LT(ate_m(recording, replayed(recording, folder_, "")), 0.006);
}

TEST_F(SensorSets, ASensorThatTheRecordingDoesNotHaveIsRefused) {
  const fs::path recording = simulated();
  fs::remove(recording / "imu.serial");
  const Ended ended =
      lxd_slam(fmt::format("replay {} --sensors LI --out {}", recording.string(), (folder_ / "run").string()));
  EXPECT_NE(ended.status, 0);
  EXPECT_TRUE(ended.says("found no recording of an IMU, wanted imu.serial or imu.csv")) << ended.text;
  EXPECT_FALSE(fs::exists(folder_ / "run"));
}

// Silence of the IMU in the middle is bridged, and what the recording plays again goes on.
TEST_F(SensorSets, AnImuThatFallsSilentAndARecordingThatIsLoopedGoOn) {
  const fs::path recording = simulated("--fault imu_gap@1.5+1");
  EXPECT_LT(ate_m(recording, replayed(recording, folder_, "--sensors LI")), 0.01);
  const RunResult twice = replayed(recording, folder_, "--sensors LIW --set replay.loops=2", "twice");
  EXPECT_EQ(twice.path().size(), 120U);
}

}  // namespace
}  // namespace lxd::test::sensor_sets_test
