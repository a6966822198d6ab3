// SPDX-License-Identifier: Apache-2.0
// What the program takes of the machine's memory is what its budget says, and stays below the profile's ceiling.
#include "board/default/capacities.hpp"
#include "tests/support/run_result.hpp"

namespace lxd::test::replay_memory_test {
namespace {

#ifndef LXD_SANITIZED  // a sanitizer's shadow memory is not the product's

double mebibytes(double bytes) { return bytes / static_cast<double>(capacities::kMebibyte); }

// Given a whole run as a process of its own, when the kernel is asked for its peak, then it keeps to the budget.
TEST(ReplayMemory, PeakOfAWholeRunIsTheBudgetAndATenthAtMost) {
  const TemporaryFolder folder;
  const Ended ended =
      lxd_slam(fmt::format("replay {} --out {}", (boxroom() / "moving").string(), (folder / "run").string()));
  ASSERT_EQ(ended.status, 0) << ended.text;
  const auto budget = nlohmann::json::parse(lxd_slam("budget --json").text);
  constexpr double kTolerance = 1.1;
  EXPECT_LE(ended.peak_rss_mib, kTolerance * mebibytes(budget["total_bytes"]));
  EXPECT_LE(ended.peak_rss_mib, mebibytes(capacities::kPeakRssBytes));

  const double reported_mib = RunResult(folder / "run").report()["peak_rss_mib"];
  EXPECT_LE(reported_mib, ended.peak_rss_mib);
  EXPECT_GE(reported_mib, 0.9 * ended.peak_rss_mib);
}

// Given a caller that is larger than any run, then the run tells its own peak, not what it grew out of.
TEST(ReplayMemory, PeakIsNotThatOfWhoStartedTheProgram) {
  const TemporaryFolder folder;
  const std::vector<char> large(2 * capacities::kPeakRssBytes, 1);
  const RunResult run = replayed(boxroom() / "moving", folder, "--set replay.sweeps=2", "short");
  EXPECT_LE(run.report()["peak_rss_mib"].get<double>(), mebibytes(static_cast<double>(large.size())) / 2);
}

// Given one recording once and ten times over, then the second run takes no more than the first, but for what the
// system libraries keep; its path begins anew ten times while its stamps go on.
TEST(ReplayMemory, StaysFlatOverTenLoops) {
  const TemporaryFolder folder;
  constexpr std::size_t kSweeps = 15, kLoops = 10;
  const auto played = [&](std::size_t loops) {
    return replayed(boxroom() / "moving", folder,
                    fmt::format("--set replay.sweeps={} --set replay.loops={}", kSweeps, loops), std::to_string(loops));
  };
  const RunResult once = played(1), often = played(kLoops);
  constexpr double kTolerance = 1.1;
  EXPECT_LE(often.report()["peak_rss_mib"].get<double>(), kTolerance * once.report()["peak_rss_mib"].get<double>());

  const auto one = once.path(), all = often.path();
  ASSERT_EQ(one.size(), kSweeps);
  ASSERT_EQ(all.size(), kLoops * kSweeps);
  for (std::size_t i = 1; i < all.size(); ++i) {
    ASSERT_GT(all[i].stamp, all[i - 1].stamp);
    ASSERT_LT((all[i].T.p - one[i % kSweeps].T.p).norm(), 1e-6) << i;
  }
  EXPECT_TRUE(often.report()["degraded"].empty());
}

#endif

}  // namespace
}  // namespace lxd::test::replay_memory_test
