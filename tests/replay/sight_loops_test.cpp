// SPDX-License-Identifier: Apache-2.0
// A simulated rig with a camera goes round and round: it knows by sight where it has been, says the same every time,
// and without a camera nothing is different.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tests/support/run_result.hpp"
#include "tools/evaluate/associate.hpp"

namespace lxd::test::sight_loops_test {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRig = R"yaml(
world: building
motion: {carrier: path, file: round.tum, rest_s: 1}
duration_s: 30
lidar0: {model: ouster, product: OS0, beams: 16, columns: 512}
imu: {protocol: vectornav, update_rate: 100}
camera0:
  resolution: [320, 240]
  intrinsics: [210, 210, 159.5, 119.5]
  distortion_model: none
  rate_hz: 10
  T_body_sensor: [[0, 0, 1, 0.05], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]]
)yaml";
constexpr int kSeed = 1;

// Three rounds of 0.6 m about a free place of that building, looking outwards.
std::string rounds() {
  constexpr double kMiddle_x_m = 1.68, kMiddle_y_m = -0.29, kHeight_m = 1.45, kRadius_m = 0.6, kRounds = 3;
  constexpr double kBegin_s = 3, kEnd_s = 29, kFile_s = 36, kStep_s = 0.02;
  std::string path;
  for (int i = 0; i * kStep_s < kFile_s; ++i) {
    const double share = std::clamp((i * kStep_s - kBegin_s) / (kEnd_s - kBegin_s), 0.0, 1.0);
    const double yaw = 2 * std::numbers::pi * kRounds * share;
    path += fmt::format("{:.3f} {:.6f} {:.6f} {:.6f} 0 0 {:.9f} {:.9f}\n", i * kStep_s,
                        kMiddle_x_m + kRadius_m * std::cos(yaw), kMiddle_y_m + kRadius_m * std::sin(yaw), kHeight_m,
                        std::sin(yaw / 2), std::cos(yaw / 2));
  }
  return path;
}

// Sub-meshes of a metre, so that what was seen a round ago is not what the filter registers against; and no surfaces,
// so that whatever closes does by sight.
const std::string kBySight =
    "--set loops.by_sight=true --set loops.by_surfaces=false --set mapping.submesh_path_m=1 "
    "--set graph.key_frame_distance_m=0.3";

class SightLoops : public testing::Test {
 protected:
  fs::path simulated() {
    write_file(folder_ / "scenario.yaml", kRig);
    write_file(folder_ / "round.tum", rounds());
    const Ended ended = lxd_slam(fmt::format("simulate {} --seed {} --out {}", (folder_ / "scenario.yaml").string(),
                                             kSeed, (folder_ / "recording").string()));
    EXPECT_EQ(ended.status, 0) << ended.text;
    return folder_ / "recording";
  }

  TemporaryFolder folder_;
};

Pose pose_of(const nlohmann::json& T) {
  const auto at = [&](std::size_t i) { return T[i].get<double>(); };
  return {Eigen::Quaterniond(at(6), at(3), at(4), at(5)).toRotationMatrix(), {at(0), at(1), at(2)}};
}

// How far a loop is from what was true between its two instants; the body is the truth's.
double error_m(const nlohmann::json& loop, const Trajectory& truth) {
  const auto at = [&](const char* key) {
    const RigTime t = RigTime::from_seconds(loop[key].get<double>());
    const auto next = std::ranges::lower_bound(truth.poses, t, {}, &StampedPose::stamp);
    return next == truth.poses.end() ? truth.poses.back().T : next->T;
  };
  return ((at("from_t").inverse() * at("to_t")).p - pose_of(loop["T_from_to"]).p).norm();
}

TEST_F(SightLoops, AreFoundWhereThePathMeetsItself) {
  const fs::path recording = simulated();
  const RunResult run = replayed(recording, folder_, kBySight);
  const auto loops = run.report()["loops"], by_sight = loops["by_sight"];
  EXPECT_GT(by_sight["key_frames"], 20);
  EXPECT_EQ(by_sight["images_gone"], 0);
  EXPECT_GE(by_sight["accepted"], 2);
  EXPECT_EQ(by_sight["accepted"], loops["accepted"]);
  const auto truth = load_tum(recording / "truth.tum");
  ASSERT_TRUE(truth.ok());
  for (const auto& loop : loops["found"]) {
    EXPECT_EQ(loop["by"], "sight");
    EXPECT_LT(error_m(loop, *truth), 0.1);
  }
  const RunResult one = replayed(recording, folder_, kBySight + " --set threads=1", "one");
  for (const char* const name : {"trajectory.tum", "odometry.tum", "map.db"})
    EXPECT_TRUE(one.bytes(name) == run.bytes(name)) << name;
}

// Given no camera in use, then whether loops are sought by sight makes no difference, and nothing is told of it.
TEST_F(SightLoops, WithoutACameraAreNotMissed) {
  const fs::path recording = simulated();
  const RunResult asked = replayed(recording, folder_, kBySight + " --sensors LI", "asked");
  const RunResult unasked =
      replayed(recording, folder_, kBySight + " --set loops.by_sight=false --sensors LI", "unasked");
  EXPECT_FALSE(asked.report()["loops"].contains("by_sight"));
  for (const char* const name : {"trajectory.tum", "odometry.tum"})
    EXPECT_TRUE(asked.bytes(name) == unasked.bytes(name)) << name;
}

// The filter hears nothing of loops.
TEST_F(SightLoops, LeaveTheOdometryAsItIs) {
  const fs::path recording = simulated();
  const RunResult with = replayed(recording, folder_, kBySight, "with");
  const RunResult without = replayed(recording, folder_, kBySight + " --set loops.by_sight=false", "without");
  EXPECT_TRUE(with.bytes("odometry.tum") == without.bytes("odometry.tum"));
  EXPECT_FALSE(with.bytes("trajectory.tum") == without.bytes("trajectory.tum"));
  EXPECT_FALSE(without.report()["loops"].contains("by_sight"));
}

}  // namespace
}  // namespace lxd::test::sight_loops_test
