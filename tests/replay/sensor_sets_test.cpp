// SPDX-License-Identifier: Apache-2.0
// Simulated recordings replayed with LiDAR, IMU and wheels in every combination, through the program.
#include <array>

#include "tests/support/replay_files.hpp"
#include "tests/support/run_result.hpp"

namespace lxd::test {
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
)yaml";

struct SensorsAndError {
  const char* sensors;
  double ate_m;
};
constexpr std::array<SensorsAndError, 4> kSets{{{"L", 0.012}, {"LI", 0.006}, {"LW", 0.008}, {"LIW", 0.006}}};
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

TEST_F(SensorSets, EveryOneOfThemFollowsARobotWithoutAllocating) {
  const fs::path recording = simulated();
  for (const auto& [sensors, ate_max_m] : kSets) {
    const RunResult run = replayed(recording, folder_, std::string("--sensors ") + sensors, sensors);
    EXPECT_LT(ate_m(recording, run), ate_max_m) << sensors;
    EXPECT_EQ(run.path().size(), 60U) << sensors;
    const auto report = run.report();
    if (!report["rt_allocations"].is_null()) {
      EXPECT_EQ(report["rt_allocations"], 0) << sensors;
    }
  }
}

// With an IMU the path is the IMU's, not the LiDAR's: the sensors are used.
TEST_F(SensorSets, EachOfThemIsAPathOfItsOwn) {
  const fs::path recording = simulated();
  std::array<std::string, kSets.size()> paths;
  for (std::size_t i = 0; i < kSets.size(); ++i) {
    const char* const sensors = kSets[i].sensors;
    paths[i] = replayed(recording, folder_, std::string("--sensors ") + sensors, sensors).bytes("odometry.tum");
    for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(paths[i] == paths[k]) << sensors << " " << kSets[k].sensors;
  }
}

TEST_F(SensorSets, OneThreadAndTwoThreadsGiveTheSameBytes) {
  const fs::path recording = simulated();
  const std::string options = "--sensors LIW --set threads=";
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
  EXPECT_LT(ate_m(recording, replayed(recording, folder_, "--sensors LIW")), 0.006);
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
}  // namespace lxd::test
