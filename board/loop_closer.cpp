// SPDX-License-Identifier: Apache-2.0
#include "board/loop_closer.hpp"

#include <iterator>

namespace lxd {

void LoopCloser::note(const KeyFrame& frame) {
  path_m_ += frame.travelled_m;
  noted_.push_back({frame.sub_mesh, {.id = frame.id, .T_world_body = frame.T_world_body, .path_m = path_m_}});
}

// Sub-meshes are finished in the order in which they were begun.
std::vector<LoopMeasurement> LoopCloser::close(std::int64_t id, const SubmeshView& sub_mesh) {
  std::vector<LoopKeyFrame> frames;
  for (; !noted_.empty() && noted_.front().sub_mesh <= id; noted_.pop_front())
    if (noted_.front().sub_mesh == id) frames.push_back(noted_.front().frame);
  finder_.add({id, sub_mesh.T_map_submesh, sub_mesh.vertices}, frames);
  std::vector<LoopMeasurement> loops;
  do {
    const auto found = finder_.find();
    loops.insert(loops.end(), found.begin(), found.end());
  } while (finder_.waiting() > 0);
  return loops;
}

}  // namespace lxd
