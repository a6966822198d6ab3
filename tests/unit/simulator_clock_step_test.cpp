// SPDX-License-Identifier: Apache-2.0
// A LiDAR whose clock steps while it sends, read back through the replay's own source: one step is told, and hardly a
// sweep is lost.
#include <cmath>

#include <gtest/gtest.h>

#include "drivers/replay/rig_recording.hpp"
#include "tests/support/lidar_rig.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/lidar/livox_writer.hpp"
#include "tools/simulator/lidar/ouster_writer.hpp"

namespace lxd::test::simulator_clock_step_test {
namespace {

using namespace sim;

constexpr double kDuration_s = 3;
constexpr std::size_t kSweeps = 30, kLostMost = 2;

struct Replayed {
  std::vector<RigTime> ends;
  Rejections rejected;
};

Replayed read_back(const std::filesystem::path& folder) {
  Replayed replayed;
  auto source = open_rig_recording(folder);
  if (!source) {
    ADD_FAILURE() << source.error().message;
    return replayed;
  }
  std::vector<LidarPoint> storage(65'536);
  Sweep sweep;
  for (;;) {
    sweep = Sweep{};
    sweep.storage = storage;
    const auto found = (*source)->next(sweep);
    if (!found || !*found) break;
    replayed.ends.push_back(sweep.end);
  }
  replayed.rejected = (*source)->rejected();
  return replayed;
}

LidarRig stepping(double begin_s, double step_s, double end_s) {
  return LidarRig(kDuration_s, FaultPlan({{"lidar0_time_step", begin_s, end_s, step_s}}), hall(), false);
}

Replayed livox_replayed(const LidarRig& rig) {
  const TemporaryFolder folder;
  EXPECT_TRUE(write_livox(rig.context, without_errors(LivoxConfig{}), folder.path()).ok());
  return read_back(folder.path());
}

Replayed ouster_replayed(const LidarRig& rig) {
  const TemporaryFolder folder;
  OusterConfig config;
  config.beams = 16;
  config.columns = 512;
  EXPECT_TRUE(write_ouster(rig.context, without_errors(config), folder.path()).ok());
  return read_back(folder.path());
}

// Nearly all sweeps are there, and each a sweep's time after the one before it, but for those that were lost.
void expect_absorbed(const Replayed& replayed, const LidarRig& rig, std::uint64_t steps) {
  EXPECT_GE(replayed.ends.size(), kSweeps - kLostMost);
  EXPECT_EQ(replayed.rejected.contains("clock_step") ? replayed.rejected.at("clock_step") : 0, steps);
  constexpr double kClock_s = 0.01;
  for (const RigTime end : replayed.ends) {
    const double t_s = (end - rig.context.start).seconds();
    EXPECT_GT(t_s, 0);
    EXPECT_LT(t_s, kDuration_s + kClock_s);
  }
}

struct Step {
  double begin_s, step_s, end_s;
  std::uint64_t steps;
};
class LidarClockStep : public testing::TestWithParam<Step> {};

TEST_P(LidarClockStep, OfALivoxIsToldAndCostsHardlyASweep) {
  const Step step = GetParam();
  const LidarRig rig = stepping(step.begin_s, step.step_s, step.end_s);
  const Replayed replayed = livox_replayed(rig);
  expect_absorbed(replayed, rig, step.steps);
  EXPECT_FALSE(replayed.rejected.contains("missing_packet")) << "not one was lost";
  EXPECT_FALSE(replayed.rejected.contains("time_backwards"));
}

TEST_P(LidarClockStep, OfAnOusterIsToldAndCostsHardlyASweep) {
  const Step step = GetParam();
  const LidarRig rig = stepping(step.begin_s, step.step_s, step.end_s);
  expect_absorbed(ouster_replayed(rig), rig, step.steps);
}

INSTANTIATE_TEST_SUITE_P(Seconds, LidarClockStep,
                         testing::Values(Step{1, -1, 9, 1}, Step{1.053, 1, 9, 1}, Step{1.053, -1, 9, 1},
                                         Step{1.053, -0.4, 9, 1}, Step{1.021, 1, 2.043, 2}, Step{1.053, -30, 9, 1}));

}  // namespace
}  // namespace lxd::test::simulator_clock_step_test
