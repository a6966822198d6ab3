// SPDX-License-Identifier: Apache-2.0
// Polylines on the plane: corners rounded, lanes beside them, points along them.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace lxd::sim {

using Line = std::vector<Eigen::Vector2d>;

// Points about step_m apart along the polyline, its corners replaced by arcs of radius_m (smaller where a segment is
// too short). Closed: from the last point back to the first; the first is not repeated.
[[nodiscard]] Line rounded(std::span<const Eigen::Vector2d> corners, double radius_m, double step_m, bool closed);

// Corners of a rectangle, anticlockwise.
[[nodiscard]] Line rectangle(const Eigen::Vector2d& centre, const Eigen::Vector2d& half_m);

// A closed line's length, or an open one's.
[[nodiscard]] double length_m(std::span<const Eigen::Vector2d> line, bool closed);

// A place on a line with the direction of travel there.
struct LinePoint {
  Eigen::Vector2d at;
  Eigen::Vector2d along;  // unit

  // To the left of the direction of travel.
  [[nodiscard]] Eigen::Vector2d left(double metres) const {
    return at + metres * Eigen::Vector2d(-along.y(), along.x());
  }
  [[nodiscard]] double yaw_rad() const;
};
// s_m from the line's first point; closed lines go round.
[[nodiscard]] LinePoint point_at(std::span<const Eigen::Vector2d> line, double s_m, bool closed);

// The closed line moved to its left.
[[nodiscard]] Line beside(std::span<const Eigen::Vector2d> closed_line, double left_m);

}  // namespace lxd::sim
