// SPDX-License-Identifier: Apache-2.0
// Where a carrier is along its route, and when: at rest, off, round the bends at a speed that they allow, and at the
// end of an open route back again.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "rt/result.hpp"
#include "tools/simulator/motion/route_path.hpp"
#include "tools/simulator/random.hpp"

namespace lxd::sim {

// What a carrier can do, and how it goes about it.
struct CourseLimits {
  double speed_mps;
  double speed_change;      // part of the speed by which it wanders
  double along_mps2;        // speeding up and braking
  double across_mps2;       // in bends
  double turn_radps;        // yaw rate in bends, and half of it turning on the spot
  double corner_m;          // over how much way to either side a corner may be rounded
  double easing_s;          // over how much time starts and stops are smoothed
  double heading_easing_s;  // over how much time the heading is; 0: the body looks where it goes, exactly
  bool turns_on_the_spot;   // else it stays at the end of an open route
};

struct CourseTimes {
  double duration_s;
  double rest_s;  // negative: in motion all the time
};

struct CoursePoint {
  double t_s;
  Eigen::Vector3d p;   // on the route
  Eigen::Vector3d up;  // unit; normal of the ground, which is taken as level across the route
  double heading_rad;  // of the body, continuous; turned by pi on the way back
  double speed_mps;
  double bend_per_m;  // to the body's left
};

struct Course {
  static constexpr double kStep_s = 0.01;
  // A curve through all points (path_fit.hpp) covers this much before 0 and after the duration.
  static constexpr double kMargin_s = 1;

  double begin_s = 0;  // of the first point; the others follow every kStep_s
  double moves_s = 0;  // when the motion starts; before begin_s when there is no rest
  std::vector<CoursePoint> points;
};

// The route has a length.
Course plan_course(const RoutePath& path, const CourseLimits& limits, const CourseTimes& times, Random& random);

}  // namespace lxd::sim
