// SPDX-License-Identifier: Apache-2.0
// Boxes are drawn and refused until there are enough; rays meet them by the slab method.
#include "tools/boxroom/world.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace lxd::boxroom {
namespace {

using Eigen::Vector3d;

constexpr std::size_t kBoxes = 60;
constexpr double kNothing_m = 1e18;    // no surface along this ray
constexpr double kNearest_m = 0.05;    // nearer surfaces are the sensor's own housing
constexpr double kParallel = 1e-12;    // direction component below which a ray runs along a slab
constexpr double kPathHalfX_m = 11.5;  // area that the path may cross: a few low posts only
constexpr double kPathHalfY_m = 8.0;
constexpr double kPostRefused = 0.92;  // share of boxes in that area that are refused
constexpr double kPostClearance_m = 1.0;
constexpr double kPathEnd_s = 80.0;  // posts keep clear of the path up to here
constexpr double kPathStep_s = 0.1;

double inverse(double component) {
  if (std::abs(component) >= kParallel) return 1.0 / component;
  return 1.0 / (component < 0 ? -kParallel : kParallel);
}

struct Crossing {
  double enter_m = -kNothing_m, leave_m = kNothing_m;
};

Crossing cross(const Box& box, const Vector3d& origin_m, const Vector3d& direction) {
  Crossing crossing;
  for (int i = 0; i < 3; ++i) {
    const double per_metre = inverse(direction[i]);
    const auto [near, far] =
        std::minmax({(box.low_m[i] - origin_m[i]) * per_metre, (box.high_m[i] - origin_m[i]) * per_metre});
    crossing.enter_m = std::max(crossing.enter_m, near);
    crossing.leave_m = std::min(crossing.leave_m, far);
  }
  return crossing;
}

double range_outside_m(const Box& box, const Vector3d& origin_m, const Vector3d& direction) {
  const Crossing crossing = cross(box, origin_m, direction);
  const bool met = crossing.leave_m >= crossing.enter_m && crossing.enter_m > kNearest_m;
  return met ? crossing.enter_m : kNothing_m;
}

double range_inside_m(const Box& box, const Vector3d& origin_m, const Vector3d& direction) {
  const Crossing crossing = cross(box, origin_m, direction);
  const bool met = crossing.leave_m >= crossing.enter_m && crossing.leave_m > 0;
  return met ? crossing.leave_m : kNothing_m;
}

bool near_path(const Vector3d& centre_m, const Motion& motion) {
  for (double t_s = 0; t_s < kPathEnd_s; t_s += kPathStep_s) {
    const Vector3d offset_m = motion.world_body(t_s).p - centre_m;
    if (offset_m.head<2>().norm() < kPostClearance_m) return true;
  }
  return false;
}

// One draw: a box anywhere, or in the path's area sometimes a low post, or nothing.
std::optional<Box> draw_box(Noise& noise, const Motion& motion) {
  // y before x, and z before y before x: the order in which the first version of this world drew them.
  const double y_m = noise.uniform(-15, 30);
  const double x_m = noise.uniform(-21, 42);
  const double height_m = noise.uniform(0.5, 6);
  const double depth_m = noise.uniform(0.4, 2.2);
  const double width_m = noise.uniform(0.4, 2.2);
  const Vector3d centre_m(x_m, y_m, 0);
  Vector3d size_m(width_m, depth_m, height_m);
  if (std::abs(x_m) < kPathHalfX_m + width_m && std::abs(y_m) < kPathHalfY_m + depth_m) {
    if (noise.uniform(0, 1) < kPostRefused) return std::nullopt;
    size_m = Vector3d(0.3, 0.3, 0.9);
    if (near_path(centre_m, motion)) return std::nullopt;
  }
  const Vector3d half_m(size_m.x() / 2, size_m.y() / 2, 0);
  return Box{centre_m - half_m, centre_m + half_m + Vector3d(0, 0, size_m.z())};
}

}  // namespace

World::World(Noise& noise, const Motion& motion) : hall_{Vector3d(-22, -16, 0), Vector3d(22, 16, 9)} {
  while (boxes_.size() < kBoxes) {
    if (const auto box = draw_box(noise, motion)) boxes_.push_back(*box);
  }
}

double World::range_m(const Vector3d& origin_m, const Vector3d& direction) const {
  double nearest_m = range_inside_m(hall_, origin_m, direction);
  for (const Box& box : boxes_) nearest_m = std::min(nearest_m, range_outside_m(box, origin_m, direction));
  return nearest_m;
}

}  // namespace lxd::boxroom
