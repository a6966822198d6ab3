// SPDX-License-Identifier: Apache-2.0
// Every sensor is silent at once while the carrier goes on: the recorder stalled, the power supply dropped.
#include <algorithm>

#include "rt/so3.hpp"
#include "tests/support/run_result.hpp"

namespace lxd::test::total_silence_test {
namespace {

constexpr const char* kWalk = R"yaml(
world: building
motion: {carrier: handheld, route: walk, rest_s: 2}
duration_s: 13
lidar0: {model: ouster, product: OS0, beams: 32, columns: 1024}
imu: {protocol: vectornav, update_rate: 200}
)yaml";

const StampedPose& nearest(const std::vector<StampedPose>& path, RigTime t) {
  return *std::ranges::min_element(path, {}, [t](const StampedPose& p) { return std::abs((p.stamp - t).ns()); });
}

// Given a walk of which a second is missing, in which the walker goes through a door and turns by 70 degrees; when the
// sensors are back, then a place that merely looks alike is not taken for the place, nor the far side of a wall for the
// near one: the path goes on in the old map as if nothing had been.
TEST(TotalSilence, ThePlaceIsFoundAgain) {
  const TemporaryFolder folder;
  write_file(folder / "walk.yaml", kWalk);
  const auto recording = folder / "recording";
  const Ended made = lxd_slam(fmt::format("simulate {} --seed 1 --fault lidar0_off@8+1 --fault imu_gap@8+1 --out {}",
                                          (folder / "walk.yaml").string(), recording.string()));
  ASSERT_EQ(made.status, 0) << made.text;
  const RunResult run = replayed(recording, folder, "");
  const auto truth = load_tum(recording / "truth.tum");
  ASSERT_TRUE(truth.ok());

  const auto path = run.path();
  const auto at = [&](double t_s) -> const StampedPose& {
    return nearest(path, truth->poses.front().stamp + Duration::from_seconds(t_s));
  };
  const auto motion_error = [&](double from_s, double to_s) {
    const StampedPose &from = at(from_s), &to = at(to_s);
    const Pose was = from.T.inverse() * to.T;
    const Pose is = nearest(truth->poses, from.stamp).T.inverse() * nearest(truth->poses, to.stamp).T;
    return is.inverse() * was;
  };
  for (const double to_s : {9.3, 10.0, 12.5}) {
    const Pose wrong = motion_error(7.5, to_s);
    EXPECT_LT(wrong.p.norm(), 0.03) << to_s;
    EXPECT_LT(Log(wrong.R).norm(), 0.01) << to_s;
  }
  EXPECT_LE(run.report()["updates"]["untracked"], 2);  // sweeps until it is found
  EXPECT_EQ(run.report()["map"]["pieces"], 1);
}

}  // namespace
}  // namespace lxd::test::total_silence_test
