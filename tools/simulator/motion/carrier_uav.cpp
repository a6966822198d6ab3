// SPDX-License-Identifier: Apache-2.0
// A multicopter: its thrust, along the body's z, carries its weight and its acceleration, so position gives the tilt
// (differential flatness: Mellinger, Kumar, "Minimum snap trajectory generation and control for quadrotors", 2011);
// the yaw is free and swings.
#include <cmath>

#include "tools/simulator/context.hpp"
#include "tools/simulator/motion/carriers.hpp"
#include "tools/simulator/motion/path_fit.hpp"
#include "tools/simulator/motion/wander.hpp"
#include "tools/simulator/units.hpp"

namespace lxd::sim {
namespace {

constexpr double kGust_m = 0.08;             // deviation of the position, 0.2 .. 0.8 Hz, where the clearance allows
constexpr double kGustShare = 0.1;           // of the clearance
constexpr double kSwing = 40 * kDegree_rad;  // deviation of the yaw, 0.05 .. 0.3 Hz
constexpr double kRock = 0.4 * kDegree_rad;  // deviation, 2 .. 5 Hz: drag and gusts that flatness leaves out
constexpr double kFlightStart_s = 2;

struct Gusts {
  explicit Gusts(Random& random) : x(random, 0.2, 0.8), y(random, 0.2, 0.8), z(random, 0.2, 0.8) {}
  Eigen::Vector3d operator()(double t_s) const { return {x(t_s), y(t_s), z(t_s)}; }
  Wander x, y, z;
};

std::vector<PathSample> flown_way(const Course& course, const Manner& manner, Random& random) {
  const Gusts gusts(random);
  const double gust_m = manner.vigour * std::min(kGust_m, kGustShare * manner.clearance_m);
  std::vector<PathSample> samples;
  for (const CoursePoint& at : course.points) {
    const double awake = eased(at.t_s, course.moves_s, kFlightStart_s);
    const Eigen::Vector3d p = at.p + manner.height_m * Eigen::Vector3d::UnitZ() + awake * gust_m * gusts(at.t_s);
    samples.push_back({at.t_s, p, Eigen::Quaterniond::Identity()});
  }
  return samples;
}

}  // namespace

Trajectory carry_uav(const Course& course, const Manner& manner, Random& random) {
  std::vector<PathSample> samples = flown_way(course, manner, random);
  const Trajectory way = interpolate(course.begin_s, Course::kStep_s, samples);
  const Wander swing(random, 0.05, 0.3), rock_x(random, 2, 5), rock_y(random, 2, 5);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double t_s = samples[i].t_s;
    const Eigen::Vector3d thrust = way.at(t_s).a_world_mps2 + kGravity_mps2 * Eigen::Vector3d::UnitZ();
    const double awake = eased(t_s, course.moves_s, kFlightStart_s) * manner.vigour;
    const double heading = course.points[i].heading_rad + awake * kSwing * swing(t_s);
    samples[i].q =
        standing(thrust.normalized(), heading) * turned(awake * kRock * rock_x(t_s), awake * kRock * rock_y(t_s), 0);
  }
  return interpolate(course.begin_s, Course::kStep_s, samples);
}

}  // namespace lxd::sim
