// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/course.hpp"

#include <cmath>
#include <numbers>

#include "tools/simulator/motion/drive.hpp"
#include "tools/simulator/motion/smooth.hpp"

namespace lxd::sim {
namespace {

using Eigen::Vector3d;

constexpr double kSpare_s = 0.3;  // at the ends, where a curve through points does not reach or swings in
// A curve through points is at rest exactly up to 0.06 s before they move; what is derived from such a curve and then
// is one itself, twice that.
constexpr double kRestMargin_s = 0.2;

std::size_t steps(double t_s) { return static_cast<std::size_t>(std::lround(t_s / Course::kStep_s)); }
std::ptrdiff_t half_width(double easing_s) { return std::lround(easing_s / (2 * kSmoothPasses * Course::kStep_s)); }

double nearest_turn(double angle_rad, double near_rad) {
  return near_rad + std::remainder(angle_rad - near_rad, 2 * std::numbers::pi);
}

// Headings of the way at every step, continuous; where it is too steep to have one, the one before goes on.
std::vector<double> headings(const RoutePath& path, const std::vector<double>& u_m) {
  std::vector<double> headings;
  double heading = 0;
  for (const double u : u_m) {
    const Vector3d along = path.at(u).d1;
    if (has_heading(along)) heading = nearest_turn(std::atan2(along.y(), along.x()), heading);
    headings.push_back(heading);
  }
  return headings;
}

// Smoothed about the first: what does not change stays exactly as it is.
void ease(std::vector<double>& values, double easing_s) {
  const double first = values.front();
  for (double& value : values) value -= first;
  smooth(values, half_width(easing_s), 0.0);
  for (double& value : values) value += first;
}

Vector3d up_of(const Vector3d& along) {
  if (!has_heading(along)) return Vector3d::UnitZ();
  const Vector3d forward = along.normalized();
  return (Vector3d::UnitZ() - forward.z() * forward).normalized();
}

CoursePoint point_of(const RoutePath& path, const Ride& ride, const std::vector<double>& headings, std::size_t i) {
  const RoutePath::Point at = path.at(ride.u_m[i]);
  const double rate = (ride.u_m[i + 1] - ride.u_m[i - 1]) / (2 * Course::kStep_s);
  CoursePoint point;
  point.t_s = 0;
  point.p = at.p;
  point.up = up_of(at.d1);
  point.heading_rad = headings[i];
  point.speed_mps = std::abs(rate) * at.d1.norm();
  point.bend_per_m = rate < 0 ? -at.bend_per_m() : at.bend_per_m();
  return point;
}

}  // namespace

Course plan_course(const RoutePath& path, const CourseLimits& limits, const CourseTimes& times, Random& random) {
  const double ease_s = limits.easing_s + limits.heading_easing_s;  // what smoothing needs beyond either end
  const double before_s = Course::kMargin_s + kSpare_s;
  const std::size_t lead = steps(ease_s) + 1;
  const std::size_t count = steps(times.duration_s + 2 * before_s) + 1;
  const std::size_t resting = times.rest_s < 0 ? 0 : lead + steps(before_s + times.rest_s + kRestMargin_s + ease_s / 2);
  Ride way = ride(path, limits, resting, count + 2 * lead, random);
  ease(way.u_m, limits.easing_s);
  ease(way.turned_rad, limits.easing_s);
  std::vector<double> heading = headings(path, way.u_m);
  for (std::size_t i = 0; i < heading.size(); ++i) heading[i] += way.turned_rad[i];
  if (limits.heading_easing_s > 0) ease(heading, limits.heading_easing_s);

  Course course;
  course.begin_s = -static_cast<double>(steps(before_s)) * Course::kStep_s;
  course.moves_s = times.rest_s < 0 ? course.begin_s - ease_s : times.rest_s + kRestMargin_s;
  for (std::size_t i = 0; i < count; ++i) {
    course.points.push_back(point_of(path, way, heading, lead + i));
    course.points.back().t_s = course.begin_s + static_cast<double>(i) * Course::kStep_s;
  }
  return course;
}

}  // namespace lxd::sim
