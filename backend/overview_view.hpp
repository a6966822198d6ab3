// SPDX-License-Identifier: Apache-2.0
// A parallel projection of the map onto a panel of the overview, fitted so that the map fills it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace lxd {

struct View {
  Eigen::Matrix3d R_view_map = Eigen::Matrix3d::Identity();  // rows: right, up, towards the eye
  double pixels_per_m = 1;
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();   // of the panel, in right and up
  Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();  // of the panel

  // x right, y down in pixels; z towards the eye in m.
  [[nodiscard]] Eigen::Vector3d project(const Eigen::Vector3d& p_map) const {
    const Eigen::Vector3d v = R_view_map * p_map;
    return {centre_px.x() + pixels_per_m * (v.x() - centre_m.x()),
            centre_px.y() - pixels_per_m * (v.y() - centre_m.y()), v.z()};
  }
};

// Heading: direction in the map's plane that points up in the picture; elevation of the eye above the horizon.
Eigen::Matrix3d look(double heading_rad, double elevation_rad);

// Heading that lays the longer side of the path (else of the points) along the picture's width.
double main_heading(std::span<const Eigen::Vector3d> points_m);

// Shows the inner 99 % of `points_m` and all of `path_m` (map frame) within a panel of size_px about centre_px. Never
// zooms in closer than a room.
View fit_view(const Eigen::Matrix3d& R_view_map, std::span<const Eigen::Vector3d> points_m,
              std::span<const Eigen::Vector3d> path_m, const Eigen::Vector2d& centre_px,
              const Eigen::Vector2d& size_px);

// Inner interval of the values: from the `fraction` to the 1 - `fraction` quantile. {0, 0} without values.
struct Interval {
  double low = 0, high = 0;
};
Interval inner_interval(std::vector<double> values, double fraction);

}  // namespace lxd
