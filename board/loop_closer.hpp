// SPDX-License-Identifier: Apache-2.0
// Hands the back-end's key frames and the sub-meshes that are finished to the loop finder, and gives what it closes.
// Low priority; one thread.
#pragma once

#include <deque>
#include <vector>

#include "backend/archive.hpp"
#include "backend/loops/loop_finder.hpp"
#include "rt/key_frame.hpp"

namespace lxd {

class LoopCloser {
 public:
  LoopCloser() : finder_(LoopFinderConfig{}) {}

  // In order of time.
  void note(const KeyFrame& frame);
  // A sub-mesh that nothing more goes into, in the filter's world; `id` as its key frames call it. The loops that it
  // closes with earlier ones.
  std::vector<LoopMeasurement> close(std::int64_t id, const SubmeshView& sub_mesh);

  [[nodiscard]] const LoopCounters& counters() const { return finder_.counters(); }

 private:
  LoopFinder finder_;
  struct Noted {
    std::int64_t sub_mesh;
    LoopKeyFrame frame;
  };
  std::deque<Noted> noted_;  // whose sub-meshes are not finished
  double path_m_ = 0;
};

}  // namespace lxd
