// SPDX-License-Identifier: Apache-2.0
// The table of carriers, and every check that can be made beforehand.
#include "tools/simulator/motion/make_motion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "board/nearest_names.hpp"
#include "tools/simulator/motion/carriers.hpp"
#include "tools/simulator/motion/path_file.hpp"
#include "tools/simulator/world/world_makers.hpp"

namespace lxd::sim {
namespace {

// speed, its change, along, across, yaw rate, corner, easing, easing of the heading, turns on the spot
constexpr CourseLimits kHandheld{1.25, 0.2, 0.8, 1.5, 1.5, 1.0, 1.0, 1.0, true};
constexpr CourseLimits kUav{3.0, 0.2, 3.0, 4.0, 2.0, 3.0, 0.8, 0.8, true};
constexpr CourseLimits kLegged{0.8, 0.1, 0.8, 1.0, 1.2, 1.0, 0.7, 0.5, true};
constexpr CourseLimits kWheeled{1.0, 0.2, 0.6, 0.8, 1.0, 1.5, 0.8, 0, true};
constexpr CourseLimits kCar{8.0, 0.15, 1.8, 2.0, 0.6, 12.0, 1.2, 0, false};

constexpr double kTightest_m = 0.05;  // a corner that is as good as a turn on the spot

constexpr std::array<Carrier, 5> kCarriers{{
    {"handheld", "walk", 1.45, 2.5, kTightest_m, kHandheld, carry_handheld},
    {"uav", "fly", 0, 8, kTightest_m, kUav, carry_uav},
    {"legged", "walk", 0.5, 2, kTightest_m, kLegged, carry_legged},
    {"wheeled", "drive", 0.3, 3, kTightest_m, kWheeled, carry_wheeled},
    {"car", "drive", 0.9, 20, 4.5, kCar, carry_car},
}};

constexpr double kLongest_s = 4 * 3600;  // half a GB of curve
constexpr double kRouteLeast_m = 0.5;

std::string listed(std::span<const std::string_view> names) { return fmt::format("{}", fmt::join(names, ", ")); }

const Carrier* find_carrier(std::string_view name) {
  const auto* const found = std::ranges::find(kCarriers, name, &Carrier::name);
  return found == kCarriers.end() ? nullptr : found;
}

Result<const Route*> wanted_route(const World& world, std::string_view wanted) {
  if (const Route* const route = find_route(world, wanted)) return route;
  std::vector<std::string_view> names;
  for (const Route& route : world.routes) names.push_back(route.name);
  return Error{fmt::format("motion.route: found '{}', wanted a route of the world '{}': {}{}", wanted, world.name,
                           names.empty() ? "it has none; a recorded path (carrier: path) needs none" : listed(names),
                           did_you_mean(wanted, names))};
}

struct Bends {
  double sharpest_per_m = 0;
  double least_pace = 1;  // 0: the path goes straight back
};

Bends bends_of(const RoutePath& path) {
  constexpr double kStep_m = 0.05;
  Bends bends;
  for (double u = 0; u < path.length_m(); u += kStep_m) {
    const RoutePath::Point point = path.at(u);
    if (has_heading(point.d1)) bends.sharpest_per_m = std::max(bends.sharpest_per_m, std::abs(point.bend_per_m()));
    bends.least_pace = std::min(bends.least_pace, point.d1.norm());
  }
  return bends;
}

// Only at the ends of an open route is there a stop to turn round.
Status check_route(const Route& route, const Carrier& carrier, const RoutePath& path) {
  constexpr double kPaceMin = 0.15;
  const Bends bends = bends_of(path);
  if (bends.least_pace < kPaceMin)
    return Error{fmt::format("motion.route: '{}' turns back on itself on its way, wanted corners", route.name)};
  if (bends.sharpest_per_m * carrier.radius_min_m > 1)
    return Error{
        fmt::format("motion.route: '{}' bends with a radius of {:.2f} m, wanted at least {} m for a {} carrier",
                    route.name, 1 / bends.sharpest_per_m, carrier.radius_min_m, carrier.name)};
  return success();
}

Status check_numbers(const MotionConfig& config, double duration_s) {
  if (!(duration_s > 0) || duration_s > kLongest_s)
    return Error{fmt::format("duration: found {} s, wanted more than 0 s and at most {} s", duration_s, kLongest_s)};
  if (!(config.rest_s >= 0) || !std::isfinite(config.rest_s))
    return Error{fmt::format("motion.rest_s: found {}, wanted 0 or more", config.rest_s)};
  return success();
}

Result<Trajectory> generated_motion(const MotionConfig& config, const World& world, const Carrier& carrier,
                                    std::uint64_t seed, double duration_s) {
  const auto route = wanted_route(world, config.route.empty() ? carrier.route : config.route);
  if (!route) return route.error();
  if (!(route_length_m(**route) > kRouteLeast_m))
    return Error{fmt::format("motion.route: '{}' is {:.2f} m long, wanted more than {} m", (*route)->name,
                             route_length_m(**route), kRouteLeast_m)};
  if (config.speed_mps > carrier.speed_max_mps)
    return Error{fmt::format("motion.speed_mps: found {}, wanted at most {} for a {} carrier", config.speed_mps,
                             carrier.speed_max_mps, carrier.name)};
  CourseLimits limits = carrier.limits;
  if (config.speed_mps > 0) limits.speed_mps = config.speed_mps;
  const RoutePath path(**route, limits.corner_m);
  if (const Status fits = check_route(**route, carrier, path); !fits.ok()) return fits.error();
  Random random(seed, "motion");
  const Course course = plan_course(path, limits, {duration_s, config.start_moving ? -1 : config.rest_s}, random);
  const double height_m = config.height_m > 0 ? config.height_m : carrier.height_m;
  return carrier.carry(course, {height_m, config.vigour, (*route)->clearance_m}, random);
}

}  // namespace

Eigen::Quaterniond standing(const Eigen::Vector3d& up, double heading_rad) {
  const Eigen::Vector3d level(std::cos(heading_rad), std::sin(heading_rad), 0);
  Eigen::Matrix3d R;
  R.col(2) = up;
  R.col(0) = (level - up.dot(level) * up).normalized();
  R.col(1) = R.col(2).cross(R.col(0));
  return Eigen::Quaterniond(R);
}

Eigen::Quaterniond turned(double x_rad, double y_rad, double z_rad) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return AngleAxisd(x_rad, Vector3d::UnitX()) * AngleAxisd(y_rad, Vector3d::UnitY()) *
         AngleAxisd(z_rad, Vector3d::UnitZ());
}

Result<Trajectory> make_motion(const MotionConfig& config, const World& world, std::uint64_t seed, double duration_s) {
  if (const Status sound = check_numbers(config, duration_s); !sound.ok()) return sound.error();
  if (config.carrier == "path") return recorded_motion(config, duration_s);
  const Carrier* const carrier = find_carrier(config.carrier);
  if (carrier == nullptr)
    return Error{fmt::format("motion.carrier: found '{}', wanted one of {}{}", config.carrier, listed(carrier_names()),
                             did_you_mean(config.carrier, carrier_names()))};
  return generated_motion(config, world, *carrier, seed, duration_s);
}

}  // namespace lxd::sim
