// SPDX-License-Identifier: Apache-2.0
// The part of the system that lives in the arena: sweep buffers, the odometry and the mesh extraction. A replay, a live
// run and the budget make the same cuts, because they all make this.
#pragma once

#include "board/configuration.hpp"
#include "estimator/odometry.hpp"
#include "mapping/mesh_extraction.hpp"
#include "rt/arena.hpp"
#include "rt/sweep_pool.hpp"

namespace lxd {

class SlamCore {
 public:
  // The caller checks with check_fits(arena) before anything is used.
  SlamCore(const Configuration& configuration, const Star& star, Arena& arena);

  [[nodiscard]] SweepPool& sweeps() { return sweeps_; }
  [[nodiscard]] Odometry& odometry() { return odometry_; }
  [[nodiscard]] MeshExtraction& mesh_extraction() { return mesh_extraction_; }

 private:
  SweepPool sweeps_;
  Odometry odometry_;
  MeshExtraction mesh_extraction_;
};

}  // namespace lxd
