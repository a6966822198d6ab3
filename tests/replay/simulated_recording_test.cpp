// SPDX-License-Identifier: Apache-2.0
// A simulated rig from its scenario to the map of its recording, through the program.
#include <map>

#include "tests/support/replay_files.hpp"
#include "tests/support/run_result.hpp"

namespace lxd::test::simulated_recording_test {
namespace {

namespace fs = std::filesystem;

// Small sensors, so that the whole way is short; every kind of wire but the second LiDAR's.
constexpr const char* kSmallRig = R"yaml(
world: building
motion: {carrier: handheld, rest_s: 0.5, vigour: 0.3}
duration_s: 3
lidar0: {model: ouster, product: OS0, beams: 32, columns: 512}
imu: {protocol: vectornav, update_rate: 100}
camera0: {resolution: [64, 48], intrinsics: [40, 40, 31.5, 23.5], distortion_coeffs: [0, 0, 0, 0], rate_hz: 5}
wheel: {protocol: agilex}
gnss: {rate_hz: 5}
sync: {}
)yaml";

constexpr const char* kLivoxRig = R"yaml(
world: building
motion: {carrier: handheld, rest_s: 0.5, vigour: 0.3}
duration_s: 3
lidar0: {model: livox}
)yaml";

std::map<std::string, std::string> files_below(const fs::path& folder) {
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file()) files[fs::relative(entry.path(), folder).string()] = read_file(entry.path());
  }
  return files;
}

class SimulatedRecording : public testing::Test {
 protected:
  fs::path simulated(const std::string& name, const std::string& options = "", const char* scenario = kSmallRig) {
    write_file(folder_ / "scenario.yaml", scenario);
    const Ended ended = lxd_slam(fmt::format("simulate {} {} --out {}", (folder_ / "scenario.yaml").string(), options,
                                             (folder_ / name).string()));
    EXPECT_EQ(ended.status, 0) << ended.text;
    return folder_ / name;
  }
  // Of the path, m.
  double ate_m(const fs::path& recording, const RunResult& run) {
    const auto report = evaluated(
        fmt::format("--estimate {} --truth {}", (run / "odometry.tum").string(), (recording / "truth.tum").string()));
    return report["ate_m"]["rmse"];
  }

  TemporaryFolder folder_;
};

TEST_F(SimulatedRecording, HasTheSameBytesForASeedWhateverTheThreads) {
  const auto one = files_below(simulated("one", "--seed 3 --threads 1"));
  const auto two = files_below(simulated("two", "--seed 3 --threads 2"));
  const auto other = files_below(simulated("other", "--seed 4 --threads 2"));
  ASSERT_EQ(one.size(), two.size());
  for (const auto& [name, bytes] : one) EXPECT_TRUE(two.contains(name) && two.at(name) == bytes) << name;
  for (const char* const name : {"lidar0.pcap", "imu.serial", "can.log", "truth.tum", "world.ply"})
    EXPECT_TRUE(other.at(name) != one.at(name)) << name;
}

TEST_F(SimulatedRecording, HoldsAFileForEverySensorAndARigFileThatIsSound) {
  const fs::path recording = simulated("recording");
  for (const char* const name :
       {"lidar0.pcap", "lidar0.json", "imu.serial", "can.log", "gnss.nmea", "pps.csv", "gpio.csv", "camera0/times.txt",
        "camera0/000000.png", "truth.tum", "world.ply", "clocks.csv", "simulation.json"})
    EXPECT_TRUE(fs::exists(recording / name)) << name;
  const Ended checked = lxd_slam("check " + (recording / "rig.yaml").string());
  EXPECT_EQ(checked.status, 0) << checked.text;
}

TEST_F(SimulatedRecording, BecomesAPathAndAMeshOnTheHostsClock) {
  const fs::path recording = simulated("recording");
  const RunResult run = replayed(recording, folder_, "");
  EXPECT_LT(ate_m(recording, run), 0.03);
  EXPECT_GT(run.faces(), 5000U);
  const auto rejected = run.report()["rejected"];
  EXPECT_FALSE(rejected.contains("imu")) << rejected;
  const auto gnss = rejected.value("gnss", nlohmann::json::object());
  for (const auto& [cause, times] : gnss.items())
    EXPECT_TRUE(cause == "no_position" || cause == "unaligned") << cause << ' ' << times;  // walls around the antenna
}

TEST_F(SimulatedRecording, OfALivoxBecomesAPathToo) {
  const fs::path recording = simulated("livox", "", kLivoxRig);
  const RunResult run = replayed(recording, folder_, "");
  EXPECT_LT(ate_m(recording, run), 0.05);
}

TEST_F(SimulatedRecording, AsAGenericFolderBecomesAPathToo) {
  const fs::path recording = simulated("generic", "--generic");
  EXPECT_TRUE(fs::exists(recording / "lidar0/times.txt"));
  EXPECT_TRUE(fs::exists(recording / "imu.csv"));
  EXPECT_FALSE(fs::exists(recording / "lidar0.pcap"));
  EXPECT_LT(ate_m(recording, replayed(recording, folder_, "")), 0.03);
}

// As many datagrams as the fault took away are told, and a tenth of the packets does not double the error.
TEST_F(SimulatedRecording, WithLostPacketsTellsThemAndKeepsThePath) {
  const fs::path whole = simulated("whole"), lossy = simulated("lossy", "--fault lidar0_loss=0.1");
  const auto log = nlohmann::json::parse(read_file(lossy / "simulation.json"));
  const std::uint64_t lost = log["counts"]["lidar0"]["lost"];
  ASSERT_GT(lost, 0U);
  const RunResult damaged = replayed(lossy, folder_, "", "damaged");
  const auto rejected = damaged.report()["rejected"]["rig-recording"];
  EXPECT_EQ(rejected.value("incomplete_datagram", 0U), lost) << rejected;
  EXPECT_LT(ate_m(lossy, damaged), 2 * ate_m(whole, replayed(whole, folder_, "", "sound")) + 0.005);
}

TEST_F(SimulatedRecording, WithAWrongChecksumOrASensorOffGoesOn) {
  const fs::path recording = simulated("off", "--fault lidar0_off@1+0.5");
  const RunResult run = replayed(recording, folder_, "");
  EXPECT_LT(ate_m(recording, run), 0.1);
  EXPECT_GE(run.report()["updates"]["carried"], 3);  // what the LiDAR does not see, the IMU bridges
  EXPECT_GE(run.path().size(), 28U);
}

constexpr const char* kTunnelRig = R"yaml(
world: tunnel
motion: {carrier: car, speed_mps: 8, rest_s: 0.5}
duration_s: 20
lidar0: {model: ouster, product: OS1, beams: 16, columns: 512}
)yaml";

// A tunnel holds every direction but the one along it: who drives in it must be told.
TEST_F(SimulatedRecording, OfATunnelSaysThatADirectionIsOpen) {
  const RunResult run = replayed(simulated("tunnel", "", kTunnelRig), folder_, "");
  EXPECT_GT(run.report()["updates"]["degenerate"], 60);
}

TEST_F(SimulatedRecording, IsHeldAgainstItsTruthAndDrawn) {
  const fs::path recording = simulated("recording");
  const RunResult run = replayed(recording, folder_, "");
  const fs::path plots = folder_ / "run";
  const auto report = evaluated(fmt::format(
      "--estimate {} --truth {} --mesh {} --world {} --rig {} --recording {} --plots {}",
      (run / "odometry.tum").string(), (recording / "truth.tum").string(), (run / "mesh.ply").string(),
      (recording / "world.ply").string(), (recording / "rig.yaml").string(), recording.string(), plots.string()));
  EXPECT_TRUE(report.contains("mesh"));
  for (const char* const name : {"errors.png", "sensors.png"}) EXPECT_GT(fs::file_size(plots / name), 10'000U) << name;
}

}  // namespace
}  // namespace lxd::test::simulated_recording_test
