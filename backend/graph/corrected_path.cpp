// SPDX-License-Identifier: Apache-2.0
#include "backend/graph/corrected_path.hpp"

#include <algorithm>

#include "backend/graph/pose_blend.hpp"

namespace lxd {

void CorrectedPath::add(const PoseGraph& graph, int map) {
  moved_ |= graph.constrained();
  for (int i = 0; i < graph.size(); ++i)
    knots_.push_back({graph.key_frame(i).stamp, graph.correction_at(i), i == 0, map});
  for (const auto& [begin, id] : begun_)
    if (const auto correction = graph.sub_mesh_correction(id)) sub_meshes_[begin] = *correction;
  begun_.clear();
}

Pose CorrectedPath::correct(RigTime stamp, const Pose& T_world_x) const {
  if (!moved_ || knots_.empty()) return T_world_x;
  const auto after = std::ranges::upper_bound(knots_, stamp, {}, &Knot::stamp);
  if (after == knots_.begin()) return after->T_map_world * T_world_x;
  const auto before = std::prev(after);
  const Pose by_before = before->T_map_world * T_world_x;
  if (after == knots_.end() || after->first) return by_before;
  const double share = (stamp - before->stamp).seconds() / (after->stamp - before->stamp).seconds();
  return blend(by_before, after->T_map_world * T_world_x, share);
}

std::int64_t CorrectedPath::piece(RigTime stamp) const {
  if (knots_.empty()) return 0;
  const auto after = std::ranges::upper_bound(knots_, stamp, {}, &Knot::stamp);
  const Knot& knot = after == knots_.begin() ? *after : *std::prev(after);
  return knot.map == main_ ? 0 : knot.map + 1;
}

bool CorrectedPath::in_pieces() const {
  return std::ranges::any_of(knots_, [this](const Knot& knot) { return knot.map != main_; });
}

std::optional<std::int64_t> CorrectedPath::sub_mesh_id(RigTime begin) const {
  const auto found = begun_.find(begin);
  if (found == begun_.end()) return std::nullopt;
  return found->second;
}

std::optional<Pose> CorrectedPath::sub_mesh(RigTime begin) const {
  const auto found = sub_meshes_.find(begin);
  if (found == sub_meshes_.end()) return std::nullopt;
  return found->second;
}

}  // namespace lxd
