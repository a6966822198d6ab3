// SPDX-License-Identifier: Apache-2.0
#include "board/slam_core.hpp"

#include "board/default/capacities.hpp"
#include "board/sensor_streams.hpp"

namespace lxd {
namespace {

OdometrySetup setup_of(const Configuration& configuration, const Star& star) {
  const Settings& settings = configuration.settings;
  OdometrySetup setup;
  setup.estimator = settings.estimator;
  setup.mapping = settings.mapping;
  setup.map.fine = {capacities::kFineCells, capacities::kFineLayers, capacities::kFineWaitingBlocks,
                    capacities::kSweepPointsMax};
  setup.map.coarse = {capacities::kCoarseCells, capacities::kCoarseLayers, capacities::kCoarseWaitingBlocks,
                      capacities::kRegistrationPointsMax};
  setup.registration_capacity = capacities::kRegistrationPointsMax;
  setup.T_body_lidar = star.T_body_lidar0;
  setup.R_world_body = star.T_body_reference.R.transpose();
  setup.lidar1 = extra_lidar_of(configuration.rig, star, settings.estimator);
  setup.camera = camera_of(configuration.rig, star);
  setup.imu = imu_noise_of(configuration.rig, configuration.sensors);
  setup.wheel = wheel_model_of(configuration.rig, star);
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

SlamCore::SlamCore(const Configuration& configuration, const Star& star, Arena& arena)
    : sweeps_(arena, "sweeps", capacities::kSweepsInFlight, capacities::kSweepPointsMax),
      odometry_(setup_of(configuration, star), arena),
      mesh_extraction_(configuration.settings.mapping, mesh_capacity(), arena) {}

}  // namespace lxd
