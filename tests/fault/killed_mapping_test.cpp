// SPDX-License-Identifier: Apache-2.0
// A run that is killed at any moment: its archive opens, has every sub-mesh that was finished but perhaps the one that
// was being written, and can be exported and gone on from. LXD_KILLS says how many times; 5 without it, 2
// in a sanitizer's build, where each run takes half a minute.
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <map>
#include <random>
#include <thread>

#include "tests/support/run_result.hpp"

namespace lxd::test::killed_mapping_test {
namespace {

#ifdef LXD_SANITIZED
constexpr int kFewKills = 2;
#else
constexpr int kFewKills = 5;
#endif
constexpr std::size_t kWindow = 3;  // sub-meshes that the filter still registers against; older ones are finished

int kills() {
  const char* const wanted = std::getenv("LXD_KILLS");
  return wanted != nullptr ? std::atoi(wanted) : kFewKills;
}

struct Kept {
  RigTime first;
  std::string vertices;
};

std::map<std::int64_t, Kept> kept_in(const Archive& archive) {
  std::map<std::int64_t, Kept> kept;
  const Status read = archive.for_each_submesh([&](const SubmeshView& view) {
    const auto bytes = std::as_bytes(view.vertices);
    kept[view.id] = {view.first, {reinterpret_cast<const char*>(bytes.data()), bytes.size()}};
    EXPECT_FALSE(view.key_frames.empty()) << view.id;
    return success();
  });
  EXPECT_TRUE(read.ok()) << read.error().message;
  return kept;
}

class KilledMapping : public ::testing::Test {
 protected:
  // A metre a sub-mesh: one is finished every few sweeps.
  [[nodiscard]] std::string command(const std::string& out) const {
    return fmt::format("replay {} --set mapping.submesh_path_m=1 --quiet --out {}", (boxroom() / "moving").string(),
                       (folder_ / out).string());
  }
  // Sub-meshes of the whole run that were finished before the last pose that the killed one wrote.
  static std::size_t finished(const std::map<std::int64_t, Kept>& whole, const RunResult& killed) {
    const auto file = killed / "odometry.tum";
    if (!exists(file) || is_empty(file)) return 0;  // before the first pose
    const auto path = killed.path();
    std::size_t begun = 0;
    for (const auto& [id, kept] : whole) begun += kept.first < path.back().stamp ? 1 : 0;
    return begun > kWindow ? begun - kWindow : 0;
  }

  TemporaryFolder folder_;
};

TEST_F(KilledMapping, LosesAtMostTheSubMeshThatWasBeingWritten) {
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(lxd_slam(command("whole")).status, 0);
  const auto whole_run = std::chrono::steady_clock::now() - begin;
  const auto whole = kept_in(*Archive::open(folder_ / "whole/map.db"));
  ASSERT_GT(whole.size(), 6U);

  std::mt19937 engine(1);
  std::size_t kept_at_all = 0;
  for (int i = 0; i < kills(); ++i) {
    Program program(command("killed"));
    std::this_thread::sleep_for(whole_run * (engine() >> 8) / (1U << 24));
    program.signal(SIGKILL);
    (void)program.wait();
    if (!std::filesystem::exists(folder_ / "killed/map.db")) continue;  // it had not begun
    const auto archive = Archive::open(folder_ / "killed/map.db");
    // Within the first milliseconds the file is there, and the tables that say what it is are not: nothing was lost.
    if (!archive && !std::filesystem::exists(folder_ / "killed/odometry_innovation.txt")) continue;
    ASSERT_TRUE(archive.ok()) << i << ": " << archive.error().message;
    const auto kept = kept_in(*archive);
    EXPECT_GE(kept.size() + 1, finished(whole, RunResult(folder_ / "killed"))) << i;
    for (const auto& [id, sub_mesh] : kept) EXPECT_EQ(sub_mesh.vertices, whole.at(id).vertices) << i << ": " << id;
    if (kept.empty()) continue;
    ++kept_at_all;
    const std::string out = (folder_ / "out.ply").string();
    const Ended exported = lxd_slam(fmt::format("export {} --mesh {}", (folder_ / "killed").string(), out));
    EXPECT_EQ(exported.status, 0) << i << ": " << exported.text;
  }
  fmt::print("{} kills, {} with sub-meshes to keep\n", kills(), kept_at_all);
  EXPECT_GT(kept_at_all, 0U);
}

// Given what a kill has left, then the next run can go on from it.
TEST_F(KilledMapping, CanBeGoneOnFrom) {
  Program program(command("killed"));
  const auto archive = folder_ / "killed/map.db";
  const auto has_some = [&] {
    const auto opened = Archive::open(archive);
    return opened.ok() && opened->totals().submeshes > 0;
  };
  for (int i = 0; i < 6000 && !has_some(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  program.signal(SIGKILL);
  (void)program.wait();
  ASSERT_TRUE(has_some());
  const Ended next = lxd_slam(command("next") + " --map " + archive.string());
  EXPECT_EQ(next.status, 0) << next.text;
  EXPECT_TRUE(RunResult(folder_ / "next").report()["map"].contains("relocalised"));
}

}  // namespace
}  // namespace lxd::test::killed_mapping_test
