// SPDX-License-Identifier: Apache-2.0
// The same recording, rig and profile give the same bytes, however often and with however many threads.
#include <array>

#include "tests/support/run_result.hpp"

namespace lxd::test::replay_determinism_test {
namespace {

constexpr std::array kResults{
    "odometry.tum", "odometry_covariance.txt", "odometry_innovation.txt", "trajectory.tum", "mesh.ply", "cloud.ply"};
constexpr const char* kPart = "--set replay.sweeps=25 --set threads=";  // enough for a map; a sanitizer is slow

void expect_same(const RunResult& one, const RunResult& other) {
  for (const char* name : kResults) {
    EXPECT_FALSE(one.bytes(name).empty()) << name;
    EXPECT_TRUE(one.bytes(name) == other.bytes(name)) << name;  // not EXPECT_EQ: it would print megabytes
  }
}

TEST(ReplayDeterminism, OneThreadAndTwoThreadsGiveTheSameBytesAsOftenAsOneLikes) {
  const TemporaryFolder folder;
  const RunResult one = replayed(boxroom() / "moving", folder, std::string(kPart) + "1", "one");
  EXPECT_EQ(one.report()["threads"], 1);
  for (const char* name : {"second", "third"})
    expect_same(one, replayed(boxroom() / "moving", folder, kPart + std::string("1"), name));

  for (const char* name : {"two", "two-again", "two-once-more"}) {
    const RunResult two = replayed(boxroom() / "moving", folder, kPart + std::string("2"), name);
    EXPECT_EQ(two.report()["threads"], 2);
    expect_same(one, two);
  }
}

// Given the recording's pace, where another thread writes what the filter hands over, sub-meshes among it, when the
// machine kept that pace, then it has written the same bytes. Searches for loops would be left out by the clock.
TEST(ReplayDeterminism, GivenThePaceOfTheRecordingThenTheThreadThatWritesGivesTheSameBytes) {
  constexpr const char* kManySubMeshes =
      "--set mapping.submesh_path_m=2 --set estimator.budget_ms=1000 --set loops.by_surfaces=false";
  const TemporaryFolder folder;
  const RunResult paced = replayed(boxroom() / "moving", folder, std::string("--realtime ") + kManySubMeshes, "paced");
  EXPECT_EQ(paced.report()["threads"], 3);
  if (!paced.report()["dropped"].empty()) GTEST_SKIP() << "this machine is too slow at the moment";
  expect_same(replayed(boxroom() / "moving", folder, kManySubMeshes, "unpaced"), paced);
}

}  // namespace
}  // namespace lxd::test::replay_determinism_test
