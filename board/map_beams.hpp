// SPDX-License-Identifier: Apache-2.0
// The beams of the sub-meshes in the filter's window, until each has left it and its surfaces are told apart from what
// only passed by. Low-priority thread.
#pragma once

#include <filesystem>
#include <vector>

#include "backend/beam_log.hpp"
#include "estimator/sweep_outcome.hpp"
#include "rt/time.hpp"

namespace lxd {

class MapBeams {
 public:
  // Error: folder and the system's cause.
  static Result<MapBeams> create(const std::filesystem::path& folder);

  // sub_mesh_begin: of the one that the sweep went into. Error: no room on the disk.
  Status take(const SweepOutcome& outcome, RigTime sub_mesh_begin);
  // Those of the sub-mesh that began then; null: there are none, or it is too long ago.
  [[nodiscard]] const BeamLog* of(RigTime sub_mesh_begin) const;

 private:
  struct Log {
    RigTime begin = kNever;
    BeamLog beams;
  };

  std::vector<Log> logs_;
  std::size_t youngest_ = 0;
  std::vector<BeamSweep::Return> returns_;  // reused
};

}  // namespace lxd
