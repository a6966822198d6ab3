// SPDX-License-Identifier: Apache-2.0
#include "board/slam_core.hpp"

#include "board/default/capacities.hpp"

namespace lxd {
namespace {

OdometrySetup setup_of(const Settings& settings, const Pose& T_body_lidar0) {
  OdometrySetup setup;
  setup.estimator = settings.estimator;
  setup.mapping = settings.mapping;
  setup.map.fine = {capacities::kFineCells, capacities::kFineLayers, capacities::kFineWaitingBlocks,
                    capacities::kSweepPointsMax};
  setup.map.coarse = {capacities::kCoarseCells, capacities::kCoarseLayers, capacities::kCoarseWaitingBlocks,
                      capacities::kRegistrationPointsMax};
  setup.registration_capacity = capacities::kRegistrationPointsMax;
  setup.T_body_lidar = T_body_lidar0;
  return setup;
}

MeshCapacity mesh_capacity() {
  return {.layers = capacities::kFineLayers,
          .corners = capacities::kMeshCorners,
          .vertices = capacities::kMeshVertices,
          .faces = capacities::kMeshFaces,
          .boundary = capacities::kMeshBoundary};
}

}  // namespace

SlamCore::SlamCore(const Settings& settings, const Pose& T_body_lidar0, Arena& arena)
    : sweeps_(arena, "sweeps", capacities::kSweepsInFlight, capacities::kSweepPointsMax),
      odometry_(setup_of(settings, T_body_lidar0), arena),
      mesh_extraction_(settings.mapping, mesh_capacity(), arena) {}

}  // namespace lxd
