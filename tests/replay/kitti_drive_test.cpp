// SPDX-License-Identifier: Apache-2.0
// A car's drive of 71 m, KITTI raw 2011_09_26_0005, through the whole program. The recording is not the clone's.
#include <cstdlib>
#include <optional>

#include "board/default/capacities.hpp"
#include "tests/support/emulated.hpp"
#include "tests/support/run_result.hpp"

namespace lxd::test::kitti_drive_test {
namespace {

// Restored into `folder` by the script that lies beside the packed drive; none where there is no such drive.
std::optional<std::filesystem::path> unpacked(const TemporaryFolder& folder) {
  const char* const root = std::getenv("LXD_SHARED_DATA");
  if (root == nullptr) return std::nullopt;
  const auto script = std::filesystem::path(root) / "kitti_0005" / "unpack.py";
  if (!std::filesystem::exists(script)) return std::nullopt;
  const std::string command = fmt::format("{} {} > /dev/null", script.string(), folder.path().string());
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  return folder.path();
}

TEST(KittiDrive, IsReplayedWholeInRealTimeMemoryAndWithinTheKnownError) {
#ifdef LXD_SANITIZED
  GTEST_SKIP() << "120,000 points a sweep take minutes under a sanitizer, which has seen all of this code elsewhere";
#endif
  const TemporaryFolder folder;
  const auto drive = unpacked(folder);
  if (!drive) GTEST_SKIP() << "LXD_SHARED_DATA has no kitti_0005/unpack.py";
  const RunResult run = replayed(*drive / "2011_09_26", folder, "");
  const auto errors = evaluated(fmt::format("--estimate {} --truth {}", (run / "odometry.tum").string(),
                                            (*drive / "truth_velodyne.tum").string()));
  EXPECT_EQ(errors["matched"], 154);
  EXPECT_LE(errors["ate_m"]["rmse"], 0.24);  // a bound of regression: the truth itself is good for about 0.2 m

  const auto report = run.report();
  EXPECT_EQ(report["sweeps"], 154);
  EXPECT_TRUE(report["rejected"].empty()) << report["rejected"];
  EXPECT_GT(run.faces(), 100'000U);
  EXPECT_EQ(report["rt_allocations"], 0);
  if (!emulated()) {
    EXPECT_EQ(report["rt_page_faults"], 0);
  }
  EXPECT_LE(report["peak_rss_mib"].get<double>() * capacities::kMebibyte, capacities::kPeakRssBytes);
}

}  // namespace
}  // namespace lxd::test::kitti_drive_test
