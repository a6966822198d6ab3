// SPDX-License-Identifier: Apache-2.0
#include "board/loop_closer.hpp"

#include <cmath>
#include <utility>

namespace lxd {

Status LoopCloser::remember(std::shared_ptr<const Archive> earlier, int map) {
  finder_.set_source([earlier](std::int64_t id, std::vector<MeshVertex>& vertices) {
    return id <= earlier->totals().last_id && earlier->read_vertices(id, vertices);
  });
  Status read = earlier->for_each_submesh([&](const SubmeshView& sub_mesh) {
    std::vector<LoopKeyFrame> frames;
    for (const SubmeshKeyFrame& frame : sub_mesh.key_frames) {
      const Pose T = sub_mesh.T_map_submesh * frame.T_submesh_body;
      if (!frames.empty()) path_m_ += (T.p - frames.back().T_world_body.p).norm();
      frames.push_back({.id = static_cast<std::int64_t>(anchors_.size()), .T_world_body = T, .path_m = path_m_});
      anchors_.push_back({T, sub_mesh.id, map});
    }
    finder_.add_earlier({sub_mesh.id, sub_mesh.T_map_submesh, sub_mesh.vertices}, frames, map);
    return success();
  });
  first_ = static_cast<std::int64_t>(anchors_.size());
  return read;
}

void LoopCloser::note(const KeyFrame& frame) {
  path_m_ += frame.travelled_m;
  path_at_m_.push_back(path_m_);
  const auto number = static_cast<std::int64_t>(anchors_.size());
  noted_.push_back({frame.sub_mesh, {.id = number, .T_world_body = frame.T_world_body, .path_m = path_m_}});
  anchors_.push_back({frame.T_world_body, frame.sub_mesh, 0});
}

// Sub-meshes are finished in the order in which they were begun.
LoopCloser::Closed LoopCloser::close(std::int64_t id, const LoopSubmesh& sub_mesh) {
  std::vector<LoopKeyFrame> frames;
  for (; !noted_.empty() && noted_.front().sub_mesh <= id; noted_.pop_front())
    if (noted_.front().sub_mesh == id) frames.push_back(noted_.front().frame);
  Closed closed;
  if (!by_surfaces_) return closed;
  finder_.add(sub_mesh, frames);
  do {
    for (const LoopMeasurement& found : finder_.find()) take(found, closed);
  } while (finder_.waiting() > 0);
  return closed;
}

LoopCloser::Closed LoopCloser::look(VisualKeyFrame seen) {
  const double path_m = path_at_m_[static_cast<std::size_t>(seen.id)];
  seen.id += first_;
  const Anchor& anchor = anchors_[static_cast<std::size_t>(seen.id)];
  Closed closed;
  const SightPlace at{anchor.T_map_body, path_m, anchor.sub_mesh};
  if (const auto found = sight_.look(std::move(seen), at)) take(*found, closed);
  return closed;
}

// The finders count on over all maps; the graph of this path begins at zero.
void LoopCloser::take(const LoopMeasurement& found, Closed& closed) {
  LoopMeasurement loop = found;
  loop.to -= first_;
  loop.from -= first_;
  if (loop.from >= 0) {
    closed.loops.push_back(loop);
    return;
  }
  const Anchor& anchor = anchors_[static_cast<std::size_t>(found.from)];
  PlaceMeasurement place{loop.to, anchor.map, anchor.T_map_body * loop.T_from_to, loop.covariance};
  Matrix6d turn = Matrix6d::Identity();
  turn.bottomRightCorner<3, 3>() = anchor.T_map_body.R;
  place.covariance = turn * loop.covariance * turn.transpose();
  see(anchors_[static_cast<std::size_t>(found.to)], place);
  closed.places.push_back(place);
}

// One sight of a map may be wrong; from two in a row that say the same its places are known. Not by what the graph
// says: that may come later or sooner, and a run's bytes must not depend on it.
void LoopCloser::see(const Anchor& anchor, const PlaceMeasurement& place) {
  constexpr double kFloor_m = 1, kDriftShare = 0.02;
  const double path_m = path_at_m_[static_cast<std::size_t>(place.key_frame)];
  const Sight sight{anchor.T_map_body * place.T_map_body.inverse(), path_m};
  const auto [before, first] = sights_.try_emplace(place.map, sight);
  if (first) return;
  const double apart_m = (before->second.T_world_map * place.T_map_body.p - anchor.T_map_body.p).norm();
  const double way_m = std::abs(path_m - before->second.path_m);
  before->second = sight;
  if (apart_m < kFloor_m + kDriftShare * way_m) finder_.locate(place.map, sight.T_world_map, path_m);
}

void LoopCloser::begin_again(const PoseGraph& solved, int map) {
  for (std::size_t i = static_cast<std::size_t>(first_); i < anchors_.size(); ++i) {
    Anchor& anchor = anchors_[i];
    const Pose T_map_world = solved.sub_mesh_correction(anchor.sub_mesh).value_or(Pose());
    anchor = {T_map_world * anchor.T_map_body, anchor.sub_mesh, map};
  }
  finder_.begin_again([this](std::int64_t id) {
    const Anchor& anchor = anchors_[static_cast<std::size_t>(id)];
    return LoopFinder::Earlier{anchor.map, anchor.T_map_body.p};
  });
  sight_.begin_again();
  noted_.clear();
  sights_.clear();
  path_at_m_.clear();
  first_ = static_cast<std::int64_t>(anchors_.size());
}

}  // namespace lxd
