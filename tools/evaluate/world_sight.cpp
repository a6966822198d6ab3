// SPDX-License-Identifier: Apache-2.0
// Viewpoints along a path, and what is seen from them.
#include "tools/evaluate/world_sight.hpp"

#include <algorithm>
#include <cmath>

namespace lxd {
namespace {

constexpr double kRadians = std::numbers::pi / 180;
constexpr double kIncidenceMax_rad = 85 * kRadians;

LidarView view_of(const LidarRig& lidar, double range_max_m) {
  LidarView view;
  view.T_reference_lidar = lidar.T_reference_sensor;
  if (lidar.fov_deg) view.elevation_rad = {kRadians * (*lidar.fov_deg)[0], kRadians * (*lidar.fov_deg)[1]};
  view.range_m = {0, range_max_m};
  if (lidar.range_m) view.range_m = {(*lidar.range_m)[0], std::min((*lidar.range_m)[1], range_max_m)};
  view.incidence_max_rad = kIncidenceMax_rad;
  return view;
}

double turn_rad(const Pose& a, const Pose& b) {
  return 2 * std::asin(std::min((a.R - b.R).norm() / std::sqrt(8.0), 1.0));  // the chordal distance
}

}  // namespace

std::vector<LidarView> lidar_views(const Rig& rig, double range_max_m) {
  std::vector<LidarView> views{view_of(rig.lidar0, range_max_m)};
  if (rig.lidar1) views.push_back(view_of(*rig.lidar1, range_max_m));
  return views;
}

WorldSight::WorldSight(const TriangleGrid& world, std::span<const Pose> path, std::span<const LidarView> lidars,
                       double spacing_m, double spacing_rad)
    : world_(world), lidars_(lidars.begin(), lidars.end()) {
  const Pose* last = nullptr;
  for (const Pose& pose : path) {
    if (last != nullptr && (pose.p - last->p).norm() < spacing_m && turn_rad(pose, *last) < spacing_rad) continue;
    last = &pose;
    for (std::uint32_t i = 0; i < lidars_.size(); ++i) {
      const Pose T_world_lidar = pose * lidars_[i].T_reference_lidar;
      viewpoints_.push_back({T_world_lidar.p, T_world_lidar.R.col(2), i});
    }
  }
}

bool WorldSight::sees(const Viewpoint& from, const Eigen::Vector3d& p, const Eigen::Vector3d& normal) const {
  const LidarView& lidar = lidars_[from.lidar];
  const Eigen::Vector3d ray = p - from.eye;
  const double range_m = ray.norm();
  if (!(range_m >= lidar.range_m[0] && range_m <= lidar.range_m[1])) return false;
  const double height_m = from.up.dot(ray);
  if (height_m < std::sin(lidar.elevation_rad[0]) * range_m || height_m > std::sin(lidar.elevation_rad[1]) * range_m)
    return false;
  if (std::abs(normal.dot(ray)) < std::cos(lidar.incidence_max_rad) * range_m) return false;
  return !world_.hidden(from.eye, p);
}

bool WorldSight::sees(const Eigen::Vector3d& p, const Eigen::Vector3d& normal) {
  const auto found = std::ranges::find_if(viewpoints_, [&](const Viewpoint& from) { return sees(from, p, normal); });
  if (found == viewpoints_.end()) return false;
  std::iter_swap(viewpoints_.begin(), found);
  return true;
}

}  // namespace lxd
