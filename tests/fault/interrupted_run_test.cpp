// SPDX-License-Identifier: Apache-2.0
// A run that is stopped half way, by hand or by the service manager, is a whole run of what was mapped until then.
#include <chrono>
#include <csignal>
#include <thread>

#include "tests/support/room_recording.hpp"
#include "tests/support/run_result.hpp"

namespace lxd::test::interrupted_run_test {
namespace {

constexpr std::size_t kSweeps = 60;  // 6 s at the recording's pace: time to stop it in
constexpr std::size_t kPosesToSee = 3;
constexpr int kKilled = -1;

std::size_t lines_of(const std::filesystem::path& file) {
  const std::string text = read_file(file);
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

// Whether the run has written some poses before a deadline that only a hang meets.
bool under_way(const std::filesystem::path& run) {
  for (int i = 0; i < 6000; ++i) {
    if (lines_of(run / "odometry.tum") >= kPosesToSee) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

class InterruptedRun : public testing::TestWithParam<int> {};

// Given a replay under way, when it is asked to stop, then it ends well and leaves path, map, archive and report.
TEST_P(InterruptedRun, IsWholeAsFarAsItCame) {
  const RoomRecording room(kSweeps);
  const TemporaryFolder folder;
  Program program(fmt::format("replay {} --realtime --out {}", room.path().string(), (folder / "run").string()));
  ASSERT_TRUE(under_way(folder / "run"));
  program.signal(GetParam());
  const Ended ended = program.wait();
  EXPECT_EQ(ended.status, 0) << ended.text;

  const RunResult run(folder / "run");
  const std::size_t sweeps = run.report()["sweeps"];
  EXPECT_GE(sweeps, kPosesToSee);
  EXPECT_LT(sweeps, kSweeps);
  EXPECT_EQ(run.path().size(), sweeps);
  EXPECT_EQ(run.path("trajectory.tum").size(), sweeps);
  EXPECT_GT(run.faces(), 1000U);
  EXPECT_TRUE(Archive::open(run / "map.db").ok());
  EXPECT_EQ(
      lxd_slam(fmt::format("export {} --mesh {}", (folder / "run").string(), (folder / "out.glb").string())).status, 0);
}

INSTANTIATE_TEST_SUITE_P(Signals, InterruptedRun, testing::Values(SIGINT, SIGTERM),
                         [](const auto& param) { return param.param == SIGINT ? "Interrupt" : "Terminate"; });

// Given a replay that is killed outright, then the poses so far are on disk, and the folder is taken for a run again.
TEST(KilledRun, LeavesThePathSoFarAndCanBeReplaced) {
  const RoomRecording room(kSweeps);
  const TemporaryFolder folder;
  Program program(fmt::format("replay {} --realtime --out {}", room.path().string(), (folder / "run").string()));
  ASSERT_TRUE(under_way(folder / "run"));
  program.signal(SIGKILL);
  EXPECT_EQ(program.wait().status, kKilled);
  EXPECT_GE(RunResult(folder / "run").path().size(), kPosesToSee);

  const RunResult again = replayed(room.path(), folder, "--set replay.sweeps=4");
  EXPECT_EQ(again.path().size(), 4U);
}

}  // namespace
}  // namespace lxd::test::interrupted_run_test
