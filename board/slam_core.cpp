// SPDX-License-Identifier: Apache-2.0
#include "board/slam_core.hpp"

#include "board/default/capacities.hpp"

namespace lxd {
namespace {

OdometrySetup setup_of(const Settings& settings, const Pose& T_body_lidar0) {
  OdometrySetup setup;
  setup.estimator = settings.estimator;
  setup.mapping = settings.mapping;
  setup.sub_mesh.cells = capacities::kSubMeshCells;
  setup.sub_mesh.layers = capacities::kSubMeshLayers;
  setup.sub_mesh.waiting_blocks = capacities::kSubMeshWaitingBlocks;
  setup.sub_mesh.points_per_sweep = capacities::kSweepPointsMax;
  setup.registration_capacity = capacities::kRegistrationPointsMax;
  setup.T_body_lidar = T_body_lidar0;
  return setup;
}

}  // namespace

SlamCore::SlamCore(const Settings& settings, const Pose& T_body_lidar0, Arena& arena)
    : sweeps_(arena, "sweeps", capacities::kSweepsInFlight, capacities::kSweepPointsMax),
      odometry_(setup_of(settings, T_body_lidar0), arena) {}

}  // namespace lxd
