// SPDX-License-Identifier: Apache-2.0
// Hands the back-end's key frames, what a camera saw at them, and the sub-meshes that are finished to the loop finders,
// and gives what they close: with this path, or with maps that are finished, be they an earlier session's or what came
// before the filter began again. Low priority; one thread.
#pragma once

#include <deque>
#include <map>
#include <memory>
#include <vector>

#include "backend/archive.hpp"
#include "backend/graph/pose_graph.hpp"
#include "backend/loops/loop_finder.hpp"
#include "backend/sight/sight_finder.hpp"
#include "rt/key_frame.hpp"

namespace lxd {

class LoopCloser {
 public:
  // by_surfaces: false: sub-meshes close nothing.
  explicit LoopCloser(bool by_surfaces = true)
      : by_surfaces_(by_surfaces), finder_(LoopFinderConfig{}), sight_(SightFinderConfig{}) {}

  // An earlier session's map of this number, before anything else. Surfaces that have no room here are fetched from it
  // when they are needed. Error: it cannot be read.
  Status remember(std::shared_ptr<const Archive> earlier, int map);

  // In order of time.
  void note(const KeyFrame& frame);
  struct Closed {
    std::vector<LoopMeasurement> loops;
    std::vector<PlaceMeasurement> places;
  };
  // A sub-mesh that nothing more goes into, in the filter's world; `id` as its key frames call it. What it closes with
  // earlier ones.
  Closed close(std::int64_t id, const LoopSubmesh& sub_mesh);
  // What was seen at a key frame that is noted, by the graph's number of it. What that closes with earlier ones.
  Closed look(VisualKeyFrame seen);

  // The filter begins again: the path until now is in the finished map of this number, where its graph has it.
  void begin_again(const PoseGraph& solved, int map);

  [[nodiscard]] const LoopCounters& counters() const { return finder_.counters(); }
  [[nodiscard]] const SightCounters& sight_counters() const { return sight_.counters(); }

 private:
  struct Noted {
    std::int64_t sub_mesh;
    LoopKeyFrame frame;
  };
  // Of each key frame that the finder knows, by its number there.
  struct Anchor {
    Pose T_map_body;  // of this path: T_world_body
    std::int64_t sub_mesh;
    int map;
  };
  struct Sight {
    Pose T_world_map;
    double path_m;
  };
  void take(const LoopMeasurement& found, Closed& closed);
  void see(const Anchor& anchor, const PlaceMeasurement& place);

  bool by_surfaces_;
  LoopFinder finder_;
  SightFinder sight_;
  std::deque<Noted> noted_;  // whose sub-meshes are not finished
  std::vector<Anchor> anchors_;
  std::int64_t first_ = 0;  // number of this path's first key frame
  std::map<int, Sight> sights_;
  double path_m_ = 0;
  std::vector<double> path_at_m_;  // of this path's key frames
};

}  // namespace lxd
