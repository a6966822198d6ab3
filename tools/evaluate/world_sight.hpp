// SPDX-License-Identifier: Apache-2.0
// What of the world a rig could see on its way: within a LiDAR's field of view and range, not at a grazing angle, and
// with nothing in between.
#pragma once

#include <array>
#include <cstdint>
#include <numbers>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "board/rig.hpp"
#include "rt/pose.hpp"
#include "tools/evaluate/triangle_grid.hpp"

namespace lxd {

// Sees all around its z axis, between two elevations.
struct LidarView {
  Pose T_reference_lidar;
  std::array<double, 2> elevation_rad{-std::numbers::pi / 2, std::numbers::pi / 2};
  std::array<double, 2> range_m{0, 30};
  double incidence_max_rad = std::numbers::pi / 2;  // from the surface's normal
};

// Of every LiDAR of the rig; ranges end at range_max_m at the latest, a missing field of view is the whole sphere.
// Surfaces more than 85 degrees off the beam do not count: there neighbouring beams are metres apart.
std::vector<LidarView> lidar_views(const Rig& rig, double range_max_m);

class WorldSight {
 public:
  // path: T_world_reference. Viewpoints are taken where the rig has gone spacing_m or turned spacing_rad since the
  // last. Keeps a reference to the world.
  WorldSight(const TriangleGrid& world, std::span<const Pose> path, std::span<const LidarView> lidars, double spacing_m,
             double spacing_rad);

  // normal: unit, of either side. Fastest when neighbours are asked one after the other: they are mostly seen from the
  // same place, which is tried first.
  bool sees(const Eigen::Vector3d& p, const Eigen::Vector3d& normal);

  [[nodiscard]] std::size_t viewpoints() const { return viewpoints_.size(); }

 private:
  struct Viewpoint {
    Eigen::Vector3d eye;
    Eigen::Vector3d up;  // the LiDAR's z axis in the world
    std::uint32_t lidar;
  };
  [[nodiscard]] bool sees(const Viewpoint& from, const Eigen::Vector3d& p, const Eigen::Vector3d& normal) const;

  const TriangleGrid& world_;
  std::vector<LidarView> lidars_;
  std::vector<Viewpoint> viewpoints_;
};

}  // namespace lxd
