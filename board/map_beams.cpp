// SPDX-License-Identifier: Apache-2.0
#include "board/map_beams.hpp"

#include <algorithm>
#include <utility>

#include "mapping/surface_map.hpp"

namespace lxd {

Result<MapBeams> MapBeams::create(const std::filesystem::path& folder) {
  MapBeams beams;
  for (int i = 0; i < kSubMeshCount; ++i) {
    auto log = BeamLog::create(folder);
    if (!log) return log.error();
    beams.logs_.push_back({kNever, std::move(*log)});
  }
  return beams;
}

// Of the primary LiDAR alone: where the other one was is not handed over.
Status MapBeams::take(const SweepOutcome& outcome, RigTime sub_mesh_begin) {
  if (outcome.registered_primary == 0) return success();
  if (logs_[youngest_].begin != sub_mesh_begin) {
    youngest_ = (youngest_ + 1) % logs_.size();
    logs_[youngest_].begin = sub_mesh_begin;
    logs_[youngest_].beams.clear();
  }
  const auto world = [&](const Eigen::Vector3f& p_m) -> Eigen::Vector3d {
    return outcome.registered_origin_m + p_m.cast<double>();
  };
  returns_.clear();
  for (const RegisteredPoint& point : outcome.registered.first(outcome.registered_primary))
    returns_.push_back({world(point.position_m), point.to_come});
  return logs_[youngest_].beams.add({world(outcome.lidar_then_m), world(outcome.lidar_m), returns_});
}

const BeamLog* MapBeams::of(RigTime sub_mesh_begin) const {
  const auto log = std::ranges::find(logs_, sub_mesh_begin, &Log::begin);
  return log == logs_.end() ? nullptr : &log->beams;
}

}  // namespace lxd
