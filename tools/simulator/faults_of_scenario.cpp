// SPDX-License-Identifier: Apache-2.0
// Which faults a scenario's sensors know.
#include <algorithm>
#include <array>

#include "tools/simulator/camera/camera_faults.hpp"
#include "tools/simulator/gnss/gnss_writer.hpp"
#include "tools/simulator/imu/imu_faults.hpp"
#include "tools/simulator/lidar/lidar_faults.hpp"
#include "tools/simulator/simulation.hpp"
#include "tools/simulator/sync/sync_writer.hpp"
#include "tools/simulator/wheel/wheel_writer.hpp"

namespace lxd::sim {
namespace {

// Of a LiDAR's packets and clock, not of its shots.
constexpr std::array<std::string_view, 7> kOfPackets{"_loss",    "_reorder",   "_duplicate", "_serial",
                                                     "_profile", "_time_step", "_skew"};

bool is_of_packets(const KnownFault& fault) {
  return std::ranges::any_of(kOfPackets, [&](std::string_view ending) { return fault.name.ends_with(ending); });
}

// Only packets with a header say who sent them.
bool says_its_serial(const LidarConfig& lidar) {
  const auto* const ouster = std::get_if<OusterConfig>(&lidar);
  return ouster != nullptr && ouster->profile != "LEGACY";
}

}  // namespace

std::vector<KnownFault> faults_of(const Scenario& scenario, bool generic) {
  std::vector<KnownFault> all;
  const auto append = [&](std::span<const KnownFault> faults) { all.insert(all.end(), faults.begin(), faults.end()); };
  const auto append_lidar = [&](const char* sensor, const LidarConfig& lidar) {
    for (const KnownFault& fault : known_lidar_faults(sensor)) {
      const bool absent =
          (generic && is_of_packets(fault)) || (fault.name.ends_with("_serial") && !says_its_serial(lidar));
      if (!absent) all.push_back(fault);
    }
  };
  append_lidar("lidar0", scenario.lidar0);
  if (scenario.lidar1) append_lidar("lidar1", *scenario.lidar1);
  if (scenario.imu) append(imu_faults());
  if (scenario.camera0) append(camera_faults());
  if (scenario.wheel) append(wheel_faults());
  if (scenario.gnss) append(gnss_faults());
  if (scenario.sync && !generic) append(sync_faults());
  return all;
}

}  // namespace lxd::sim
