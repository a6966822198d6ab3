// SPDX-License-Identifier: Apache-2.0
// How each carrier moves its body along a course. One file a carrier.
#pragma once

#include <string_view>

#include "tools/simulator/motion/course.hpp"
#include "tools/simulator/motion/trajectory.hpp"

namespace lxd::sim {

struct Manner {
  double height_m;     // of the body above the route
  double vigour;       // of gait, shake, vibration: 1 as in life
  double clearance_m;  // the route's
};

using Carry = Trajectory (*)(const Course& course, const Manner& manner, Random& random);

struct Carrier {
  std::string_view name;
  std::string_view route;  // the kind it takes when none is named
  double height_m;
  double speed_max_mps;  // what a scenario may ask for
  double radius_min_m;   // of a bend
  CourseLimits limits;
  Carry carry;
};

Trajectory carry_handheld(const Course& course, const Manner& manner, Random& random);
Trajectory carry_uav(const Course& course, const Manner& manner, Random& random);
Trajectory carry_legged(const Course& course, const Manner& manner, Random& random);
Trajectory carry_wheeled(const Course& course, const Manner& manner, Random& random);
Trajectory carry_car(const Course& course, const Manner& manner, Random& random);

// The body on the ground: z along `up`, x as near to the heading as that allows.
Eigen::Quaterniond standing(const Eigen::Vector3d& up, double heading_rad);
// About x, then y, then z of the body: left to right, each in the frame that the one before it left.
Eigen::Quaterniond turned(double x_rad, double y_rad, double z_rad);

}  // namespace lxd::sim
