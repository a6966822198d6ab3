// SPDX-License-Identifier: Apache-2.0
#include "board/core_report.hpp"

#include <algorithm>

#include "board/default/capacities.hpp"
#include "board/found_mount.hpp"

namespace lxd {
namespace {

void raise_high_water(Report& report, const char* pool, std::uint64_t capacity, std::uint64_t used) {
  PoolUse& use = report.pools[pool];
  use.capacity = capacity;
  use.high_water = std::max(use.high_water, used);
}

MountReport mount_report(const FoundMount& mount) {
  MountReport report;
  Eigen::Vector3d::Map(report.turned_deg.data()) = mount.turned_deg;
  Eigen::Vector3d::Map(report.sigma_deg.data()) = mount.covariance_deg2.diagonal().cwiseSqrt();
  return report;
}

}  // namespace

const char* name_of(SweepRejection rejection) {
  switch (rejection) {
    case SweepRejection::time_backwards:
      return "time_backwards";
    case SweepRejection::too_few_points:
      return "too_few_points";
    default:
      return "none";
  }
}

void count_pools(SlamCore& core, Report& report) {
  raise_high_water(report, "sweeps", core.sweeps().capacity(), core.sweeps().high_water());
  const SurfaceMap& map = core.odometry().map();
  for (std::uint32_t i = 0; i < map.window_size(); ++i) {
    raise_high_water(report, "sub_mesh_cells", capacities::kFineCells, map.window(i).cells().size());
    raise_high_water(report, "sub_mesh_layers", capacities::kFineLayers, map.window(i).layer_count());
  }
}

void add_calibration(const Odometry& odometry, const Star& star, Report& report) {
  if (odometry.motion().inertial()) {
    report.imu_delay = {odometry.imu_delay().delay_s(), odometry.imu_delay().sigma_s()};
    report.imu_mount = mount_report(found_mount(odometry.imu_mount(), odometry.motion().imu_unlike(), star));
  }
  if (star.T_body_wheel) {
    const WheelAlignment& wheel = odometry.motion().wheel_alignment();
    report.wheel_delay = {wheel.delay_s(), wheel.delay_sigma_s()};
  }
  if (odometry.vision() == nullptr) return;
  const CameraAlignment& camera = odometry.vision()->alignment();
  report.camera_delay = {camera.delay_s(), camera.delay_sigma_s()};
  report.camera_mount = mount_report(found_mount(camera, star));
}

}  // namespace lxd
