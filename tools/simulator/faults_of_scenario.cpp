// SPDX-License-Identifier: Apache-2.0
// Which faults a scenario's sensors know.
#include "tools/simulator/camera/camera_faults.hpp"
#include "tools/simulator/gnss/gnss_writer.hpp"
#include "tools/simulator/imu/imu_faults.hpp"
#include "tools/simulator/lidar/lidar_faults.hpp"
#include "tools/simulator/simulation.hpp"
#include "tools/simulator/sync/sync_writer.hpp"
#include "tools/simulator/wheel/wheel_writer.hpp"

namespace lxd::sim {

std::vector<KnownFault> faults_of(const Scenario& scenario) {
  std::vector<KnownFault> all;
  const auto append = [&](std::span<const KnownFault> faults) { all.insert(all.end(), faults.begin(), faults.end()); };
  append(known_lidar_faults("lidar0"));
  if (scenario.lidar1) append(known_lidar_faults("lidar1"));
  if (scenario.imu) append(imu_faults());
  if (scenario.camera0) append(camera_faults());
  if (scenario.wheel) append(wheel_faults());
  if (scenario.gnss) append(gnss_faults());
  if (scenario.sync) append(sync_faults());
  return all;
}

}  // namespace lxd::sim
