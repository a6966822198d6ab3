// SPDX-License-Identifier: Apache-2.0
// A route with its corners rounded: a smooth curve along which a carrier can go.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "tools/simulator/motion/trajectory.hpp"
#include "tools/simulator/world/world.hpp"

namespace lxd::sim {

// The parameter u, in m, is the length along the route's own polyline; the curve is shorter than it in rounded corners.
class RoutePath {
 public:
  struct Point {
    Eigen::Vector3d p;
    Eigen::Vector3d d1;                       // by u; shorter than 1 in corners
    Eigen::Vector3d d2;                       // by u
    [[nodiscard]] double bend_per_m() const;  // of the horizontal course, positive to the left
  };

  // Rounds corners by as much as the route's clearance allows, at most over corner_m to either side of each.
  // The route has at least two different points.
  RoutePath(const Route& route, double corner_m);

  [[nodiscard]] double length_m() const { return length_m_; }
  [[nodiscard]] bool closed() const { return closed_; }
  // A closed path goes round and round; an open one is held at its ends.
  [[nodiscard]] Point at(double u_m) const;
  [[nodiscard]] double deviation_m() const { return deviation_m_; }  // from the route, at most

 private:
  RoutePath(const Route& route, std::vector<Eigen::Vector3d> way, double corner_m);
  static Trajectory rounded(const std::vector<Eigen::Vector3d>& points, bool closed, double step_m);

  bool closed_;
  double length_m_;
  double deviation_m_ = 0;
  Trajectory curve_;  // over u instead of time
};

double route_length_m(const Route& route);

// Whether a way in this direction is level enough to have a heading.
bool has_heading(const Eigen::Vector3d& along);

}  // namespace lxd::sim
