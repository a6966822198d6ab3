// SPDX-License-Identifier: Apache-2.0
// What rolls: a robot that turns on the spot, and a car. Neither moves sideways: the body is straight above the middle
// of the axle that does not steer, and its y axis is kept across the way. Roll is about the way's own direction and
// pitch about that y axis, so neither of them gives the body a sideways speed.
#include <cmath>

#include "tools/simulator/motion/carriers.hpp"
#include "tools/simulator/motion/path_fit.hpp"
#include "tools/simulator/motion/smooth.hpp"
#include "tools/simulator/motion/wander.hpp"
#include "tools/simulator/units.hpp"

namespace lxd::sim {
namespace {

// How the body gives on its wheels.
struct Suspension {
  double roll_per_mps2;   // outwards in a bend
  double pitch_per_mps2;  // nose up when speeding up
  double vibration_rad;   // deviation at full speed, of roll and of pitch
  double full_mps;
  double low_hz, high_hz;
};

constexpr Suspension kRobot{0.1 * kDegree_rad, 0.15 * kDegree_rad, 0.06 * kDegree_rad, 1.0, 4, 10};
constexpr Suspension kCarSprings{0.5 * kDegree_rad, 0.4 * kDegree_rad, 0.05 * kDegree_rad, 8.0, 5, 11};
constexpr std::ptrdiff_t kLag = 5;  // half width, in steps, of the means that make it give slowly

struct Forces {
  std::vector<double> along_mps2, across_mps2;
};

// Smoothed, and late by as much as smoothing reaches: nothing moves before the wheels do.
void lag(std::vector<double>& values) {
  smooth(values, kLag, 0.0);
  const std::size_t reach = std::min<std::size_t>(kSmoothPasses * kLag, values.size());
  values.insert(values.begin(), reach, values.front());
  values.resize(values.size() - reach);
}

Forces forces_of(const Course& course) {
  Forces forces;
  const std::vector<CoursePoint>& points = course.points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double before = points[i == 0 ? 0 : i - 1].speed_mps;
    forces.along_mps2.push_back((points[i].speed_mps - before) / Course::kStep_s);
    forces.across_mps2.push_back(points[i].speed_mps * points[i].speed_mps * points[i].bend_per_m);
  }
  lag(forces.along_mps2);
  lag(forces.across_mps2);
  return forces;
}

Trajectory carry(const Course& course, const Manner& manner, const Suspension& suspension, Random& random) {
  const Forces forces = forces_of(course);
  const Wander roll(random, suspension.low_hz, suspension.high_hz);
  const Wander pitch(random, suspension.low_hz, suspension.high_hz);
  std::vector<PathSample> samples;
  for (std::size_t i = 0; i < course.points.size(); ++i) {
    const CoursePoint& at = course.points[i];
    const double rough = manner.vigour * suspension.vibration_rad * at.speed_mps / suspension.full_mps;
    const Eigen::Quaterniond give =
        turned(manner.vigour * suspension.roll_per_mps2 * forces.across_mps2[i] + rough * roll(at.t_s),
               -manner.vigour * suspension.pitch_per_mps2 * forces.along_mps2[i] + rough * pitch(at.t_s), 0);
    samples.push_back(
        {at.t_s, at.p + manner.height_m * Eigen::Vector3d::UnitZ(), standing(at.up, at.heading_rad) * give});
  }
  return interpolate(course.begin_s, Course::kStep_s, samples);
}

}  // namespace

Trajectory carry_wheeled(const Course& course, const Manner& manner, Random& random) {
  return carry(course, manner, kRobot, random);
}

Trajectory carry_car(const Course& course, const Manner& manner, Random& random) {
  return carry(course, manner, kCarSprings, random);
}

}  // namespace lxd::sim
