// SPDX-License-Identifier: Apache-2.0
// Motions of KITTI's car, which closes loops: what is solved on the way ends where a batch solution does.
#include <gtest/gtest.h>

#include "tests/support/data_folders.hpp"
#include "tests/support/graph_and_batch.hpp"
#include "tests/support/graph_story.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tools/simulator/motion/path_file.hpp"

namespace lxd::backend_graph_real_motion_test {
namespace {

constexpr double kStep_m = 2, kNear_m = 8;
constexpr int kLater = 100;  // key frames

std::vector<Pose> every_two_metres(const sim::RecordedPath& recorded) {
  std::vector<Pose> path;
  for (const sim::PathSample& sample : recorded.samples)
    if (path.empty() || (sample.p - path.back().p).norm() >= kStep_m)
      path.push_back({sample.q.normalized().toRotationMatrix(), sample.p});
  return path;
}

// Where it has been before: the nearest of the old key frames, at every third that is near one.
std::vector<std::pair<int, int>> revisits(const std::vector<Pose>& path) {
  std::vector<std::pair<int, int>> found;
  const auto n = static_cast<int>(path.size());
  const auto distance_m = [&](int i, int j) {
    return (path[static_cast<std::size_t>(i)].p - path[static_cast<std::size_t>(j)].p).norm();
  };
  for (int j = kLater; j < n; j += 3) {
    int best = 0;
    for (int i = 0; i < j - kLater; ++i)
      if (distance_m(i, j) < distance_m(best, j)) best = i;
    if (distance_m(best, j) < kNear_m) found.emplace_back(best, j);
  }
  return found;
}

class GraphOfRealMotion : public ::testing::TestWithParam<const char*> {};

TEST_P(GraphOfRealMotion, SolvedOnTheWayItCostsWhatABatchCosts) {
  const auto packed = test::shared_data(std::string("motion/") + GetParam() + "_oxts.csv.xz");
  if (!packed) GTEST_SKIP() << "no LXD_SHARED_DATA with motion/" << GetParam() << "_oxts.csv.xz";
  const test::TemporaryFolder folder;
  const auto file = folder / "path.csv";
  if (std::system(("xz -dc '" + packed->string() + "' > '" + file.string() + "'").c_str()) != 0)
    GTEST_SKIP() << "no xz";
  const auto recorded = sim::load_path(file, "oxts");
  ASSERT_TRUE(recorded.ok()) << recorded.error().message;

  test::GraphStory story;
  story.drive(every_two_metres(*recorded), {});
  std::vector<LoopMeasurement> loops;
  for (const auto& [i, j] : revisits(story.truth)) loops.push_back(story.loop(i, j));
  ASSERT_GE(loops.size(), 3u);
  const test::GraphAndBatch both(story.key_frames, loops);
  test::expect_costs_of_batch(both);
  EXPECT_LT(both.cost_on_the_way, 4 * both.batch.cost());  // the last loops have moved sub-meshes only
  EXPECT_LE(test::aligned_error_m(story.truth, both.graph), test::aligned_error_m(story.truth, both.odometry));
}

INSTANTIATE_TEST_SUITE_P(Kitti, GraphOfRealMotion, ::testing::Values("kitti_06", "kitti_09"));

}  // namespace
}  // namespace lxd::backend_graph_real_motion_test
