// SPDX-License-Identifier: Apache-2.0
// The graph, and the thread that solves it and searches for loops: low priority, off the path of the sweeps. What it is
// told comes out of one queue in order, and the graph is solved at key frames only, so that its poses do not depend on
// how fast it runs.
#pragma once

#include <functional>
#include <mutex>
#include <optional>
#include <variant>

#include "backend/graph/pose_graph.hpp"
#include "board/task_thread.hpp"
#include "rt/latency_histogram.hpp"

namespace lxd {

class GraphWorker {
 public:
  // Without a thread of its own all is done within post().
  GraphWorker(const GraphConfig& config, bool own_thread);

  // Longer work that tells the graph what it finds, such as the search for the loops of a sub-mesh.
  using Task = std::function<void(PoseGraph&)>;
  // A key frame, and then what was measured at it. From one thread.
  using News = std::variant<KeyFrame, LoopMeasurement, PlaceMeasurement, GnssMeasurement, Task>;
  void post(const News& news);

  // Works off the queue, solves all to the end and ends the thread. Then the graph may be looked at.
  const PoseGraph& finish();

  // As the graph had it last. From any thread.
  struct Whereabouts {
    Pose T_map_world;
    bool in_finished_map = false;  // the map's frame is that one's; else it is this path's own
  };
  [[nodiscard]] Whereabouts whereabouts() const;
  // Of the work on one key frame. After finish().
  [[nodiscard]] const LatencyHistogram& latency() const { return latency_; }

 private:
  void work_on(const News& news);
  void solve();
  void add(const Task& task) { task(graph_); }
  template <typename Measured>
  void add(const Measured& measured) {
    graph_.add(measured);
  }

  PoseGraph graph_;
  LatencyHistogram latency_;
  mutable std::mutex mutex_;
  Whereabouts whereabouts_;
  bool finished_ = false;
  std::optional<TaskThread> thread_;  // last: ends before what it works on
};

}  // namespace lxd
