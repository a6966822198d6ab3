// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/sensor_places.hpp"

#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tools/simulator/world/clearance.hpp"

namespace lxd::sim {
namespace {

constexpr double kStep_s = 0.05;
// A sensor's housing, about. The ground below is the body's matter.
constexpr ClearanceRules kHousing{.radius_m = 0.05, .below_m = 0.05, .needs_ground = false, .sample_m = 0};

struct Mounted {
  const char* sensor;
  Eigen::Vector3d p_body_m;
};

Eigen::Vector3d place_of(const LidarConfig& lidar) {
  return std::visit([](const auto& config) -> Eigen::Vector3d { return config.T_body_sensor.p; }, lidar);
}

std::vector<Mounted> sensors_of(const Scenario& scenario) {
  std::vector<Mounted> sensors{{"lidar0", place_of(scenario.lidar0)}};
  if (scenario.lidar1) sensors.push_back({"lidar1", place_of(*scenario.lidar1)});
  if (scenario.imu) sensors.push_back({"imu", scenario.imu->T_body_sensor.p});
  if (scenario.camera0) sensors.push_back({"camera0", scenario.camera0->T_body_sensor.p});
  if (scenario.gnss) sensors.push_back({"gnss", scenario.gnss->antenna_in_reference_m});
  return sensors;
}

Error in_the_way(const char* sensor, std::size_t step, const Eigen::Vector3d& p, const std::string& what) {
  return Error{fmt::format("{}: at {:.2f} s, at {:.2f} {:.2f} {:.2f} m, the sensor {}; wanted it in free space", sensor,
                           static_cast<double>(step) * kStep_s, p.x(), p.y(), p.z(), what)};
}

Status check_place(const Context& context, const std::vector<Pose>& poses, const Mounted& mounted) {
  std::vector<Eigen::Vector3d> path_m;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    path_m.push_back(poses[i] * mounted.p_body_m);
    if (const auto surface = surface_between(context.scene, poses[i].p, path_m.back()))
      return in_the_way(mounted.sensor, i, path_m.back(), fmt::format("is behind {}, seen from the body", *surface));
  }
  if (const auto collision = first_collision(context.scene, path_m, kHousing))
    return in_the_way(mounted.sensor, collision->index, path_m[collision->index], collision->what);
  return success();
}

}  // namespace

Status check_sensor_places(const Context& context, const Scenario& scenario) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; static_cast<double>(i) * kStep_s <= context.duration_s; ++i)
    poses.push_back(context.motion.pose(static_cast<double>(i) * kStep_s));
  for (const Mounted& mounted : sensors_of(scenario)) {
    const Status free = check_place(context, poses, mounted);
    if (!free) return free;
  }
  return success();
}

}  // namespace lxd::sim
