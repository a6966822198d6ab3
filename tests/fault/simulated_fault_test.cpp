// SPDX-License-Identifier: Apache-2.0
// What the simulator broke is what a replay tells, sensor by sensor and number by number, and the path goes on.
#include "tests/support/replay_files.hpp"
#include "tests/support/run_result.hpp"

namespace lxd::test::simulated_fault_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRig = R"yaml(
world: parking
motion: {carrier: wheeled, rest_s: 0.5}
duration_s: 4
lidar0: {model: ouster, product: OS0, beams: 32, columns: 512}
imu: {protocol: vectornav, update_rate: 100}
wheel: {protocol: toyota, track_m: 1.5}
gnss: {rate_hz: 5}
)yaml";

class SimulatedFault : public testing::Test {
 protected:
  void play(const std::string& faults) {
    write_file(folder_ / "rig.scenario", kRig);
    const Ended ended = lxd_slam(
        fmt::format("simulate {} {} --out {}", (folder_ / "rig.scenario").string(), faults, recording().string()));
    ASSERT_EQ(ended.status, 0) << ended.text;
    counts_ = nlohmann::json::parse(read_file(recording() / "simulation.json"))["counts"];
    run_.emplace(replayed(recording(), folder_, ""));
    rejected_ = run_->report()["rejected"];
  }
  [[nodiscard]] std::uint64_t told(const char* sensor, const char* cause) const {
    return rejected_.contains(sensor) ? rejected_[sensor].value(cause, std::uint64_t{0}) : 0;
  }
  [[nodiscard]] std::uint64_t done(const char* sensor, const char* what) const { return counts_[sensor][what]; }
  [[nodiscard]] double ate_m() const {
    return evaluated(fmt::format("--estimate {} --truth {}", (*run_ / "odometry.tum").string(),
                                 (recording() / "truth.tum").string()))["ate_m"]["rmse"];
  }
  [[nodiscard]] fs::path recording() const { return folder_ / "recording"; }

  TemporaryFolder folder_;
  nlohmann::json counts_, rejected_;
  std::optional<RunResult> run_;
};

TEST_F(SimulatedFault, OfNothingIsToldOfNothing) {
  play("");
  for (const char* const sensor : {"imu", "wheel"}) EXPECT_FALSE(rejected_.contains(sensor)) << rejected_;
  // A car that has not gone far has not told the back-end yet how its map lies on the earth.
  auto gnss = rejected_.value("gnss", nlohmann::json::object());
  gnss.erase("unaligned");
  EXPECT_TRUE(gnss.empty()) << gnss;
  EXPECT_LT(ate_m(), 0.02);
}

TEST_F(SimulatedFault, ThatMakesNumbersOfTheImuNoneIsTold) {
  play("--fault imu_nan@1+0.2");
  EXPECT_GT(done("imu", "nan"), 0U);
  EXPECT_EQ(told("imu", "non_finite"), done("imu", "nan"));
}

TEST_F(SimulatedFault, ThatBreaksChecksumsOfTheBusIsTold) {
  play("--fault can_checksum@1+1 --fault can_bus_off@3+0.5");
  EXPECT_GT(done("wheel", "bad_checksums"), 0U);
  EXPECT_EQ(told("wheel", "bad_checksum"), done("wheel", "bad_checksums"));
  EXPECT_EQ(told("wheel", "error_frame"), done("wheel", "error_frames"));
  EXPECT_GT(told("wheel", "bus_off"), 0U);
}

TEST_F(SimulatedFault, ThatPutsAnotherSensorInItsPlaceCostsItsPacketsOnly) {
  play("--fault lidar0_serial@2+1");
  EXPECT_GT(done("lidar0", "other_serial"), 0U);
  EXPECT_EQ(told("rig-recording", "bad_serial"), done("lidar0", "other_serial"));
  EXPECT_LT(ate_m(), 0.05);
}

// The sensor is silent for a second and then counts from zero with another init id.
TEST_F(SimulatedFault, ThatRestartsTheLidarIsToldOnceAndTheMapIsKept) {
  play("--fault lidar0_restart@1.5+1");
  EXPECT_GT(done("lidar0", "other_init_id"), 0U);
  EXPECT_EQ(told("rig-recording", "sensor_restart"), 1U);
  EXPECT_EQ(told("rig-recording", "clock_step"), 1U);
  EXPECT_GT(run_->path().back().stamp - run_->path().front().stamp, Duration::from_seconds(3.5));
  EXPECT_LT(ate_m(), 0.05);
}

TEST_F(SimulatedFault, ThatStepsTheLidarsClockLeavesThePathInRigTime) {
  play("--fault lidar0_time_step@2=1");
  EXPECT_EQ(told("rig-recording", "clock_step"), 1U);
  EXPECT_LT(ate_m(), 0.05);
}

}  // namespace
}  // namespace lxd::test::simulated_fault_test
