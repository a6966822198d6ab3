// SPDX-License-Identifier: Apache-2.0
// The same measurements solved twice: key frame by key frame as they come, and all at once when all are known.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "backend/graph/pose_graph.hpp"

namespace lxd::test {

struct GraphAndBatch {
  PoseGraph graph{{}}, batch{{}};
  PoseGraph odometry{{}};      // knows of no loop
  double cost_on_the_way = 0;  // of `graph` before it was finished

  // A loop becomes known with the later of its key frames.
  GraphAndBatch(const std::vector<KeyFrame>& key_frames, std::vector<LoopMeasurement> loops) {
    const auto known_at = [](const LoopMeasurement& loop) { return std::max(loop.from, loop.to); };
    std::ranges::stable_sort(loops, {}, known_at);
    auto loop = loops.begin();
    for (const KeyFrame& frame : key_frames) {
      graph.add(frame);
      batch.add(frame);
      odometry.add(frame);
      for (; loop != loops.end() && known_at(*loop) == frame.id; ++loop) graph.add(*loop);
      graph.update();
    }
    for (const LoopMeasurement& closed : loops) batch.add(closed);
    cost_on_the_way = graph.cost();
    graph.finish();
    batch.finish();
  }
};

// In the end the two cost the same within a hundredth; the figures are recorded with the test.
inline void expect_costs_of_batch(const GraphAndBatch& both) {
  const auto record = [](const char* name, double value) {
    ::testing::Test::RecordProperty(name, std::to_string(value));
  };
  ::testing::Test::RecordProperty("key_frames", both.graph.size());
  ::testing::Test::RecordProperty("loops_proposed", static_cast<int>(both.graph.loop_counts().proposed));
  ::testing::Test::RecordProperty("loops", static_cast<int>(both.graph.loop_counts().accepted));
  record("cost_on_the_way", both.cost_on_the_way);
  record("cost", both.graph.cost());
  record("cost_batch", both.batch.cost());
  EXPECT_EQ(both.graph.loop_counts().accepted, both.batch.loop_counts().accepted);
  EXPECT_NEAR(both.graph.cost(), both.batch.cost(), 0.01 * both.batch.cost());
}

}  // namespace lxd::test
