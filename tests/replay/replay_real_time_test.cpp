// SPDX-License-Identifier: Apache-2.0
// The real-time path over a whole replay: it neither allocates nor meets a page fault. In the real-time sanitizer's
// build the program ends at the first blocking call within a step, so that ending well is the proof.
#include "tests/support/emulated.hpp"
#include "tests/support/run_result.hpp"

namespace lxd::test::replay_real_time_test {
namespace {

void expect_real_time(const nlohmann::json& report) {
#ifdef LXD_SANITIZED
  EXPECT_TRUE(report["rt_allocations"].is_null());  // a sanitizer's build cannot count, and says so
#else
  EXPECT_EQ(report["rt_allocations"], 0);
  if (!emulated()) {
    EXPECT_EQ(report["rt_page_faults"], 0);
  }
#endif
}

TEST(ReplayRealTime, GivenAWholeRecordingThenNoStepAllocatesOrFaultsOnAPage) {
  const TemporaryFolder folder;
  const RunResult run = replayed(boxroom() / "moving", folder, "");
  EXPECT_EQ(run.report()["sweeps"], 60);
  expect_real_time(run.report());
}

// One thread reads and registers in turn: what reading allocates is not the step's.
TEST(ReplayRealTime, GivenOneThreadThenTheStepsStayClean) {
  const TemporaryFolder folder;
  expect_real_time(replayed(boxroom() / "frozen", folder, "--set threads=1 --set replay.sweeps=10").report());
}

// Given ways so short that sub-meshes retire during the run, when they are handed over, then the steps stay clean.
TEST(ReplayRealTime, GivenSubMeshesThatRetireThenTheStepsStayClean) {
  const TemporaryFolder folder;
  const RunResult run = replayed(boxroom() / "moving", folder, "--set mapping.submesh_path_m=1");
  expect_real_time(run.report());
  const auto archive = Archive::open(run / "map.db");
  ASSERT_TRUE(archive.ok()) << archive.error().message;
  EXPECT_GT(archive->totals().submeshes, 4U);  // more than the window holds: some retired
}

TEST(ReplayRealTime, GivenThePaceOfTheRecordingThenTheStepsStayClean) {
  const TemporaryFolder folder;
  expect_real_time(replayed(boxroom() / "moving", folder, "--realtime --set replay.sweeps=10").report());
}

#if defined(__has_feature)
#if __has_feature(realtime_sanitizer)
// Given the sanitizer's build, then it watches the program too, not only the tests.
TEST(ReplayRealTime, GivenTheSanitizerThenItWatchesTheProgram) {
  ::setenv("RTSAN_OPTIONS", "print_stats_on_exit=1", 1);
  const Ended ended = lxd_slam("budget");
  EXPECT_EQ(ended.status, 0);
  EXPECT_TRUE(ended.says("RealtimeSanitizer exit stats")) << ended.text;
}
#endif
#endif

}  // namespace
}  // namespace lxd::test::replay_real_time_test
