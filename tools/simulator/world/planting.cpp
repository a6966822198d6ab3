// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/planting.hpp"

#include <algorithm>

#include "tools/simulator/world/things.hpp"

namespace lxd::sim {
namespace {

constexpr double kGap_m = 0.3;  // between things

}  // namespace

Footprint Planting::standing(const Eigen::Vector2d& at, const Eigen::Vector2d& half_m, double yaw_rad,
                             double height_m) const {
  const double z = ground_.height_m(at);
  return {at, half_m, yaw_rad, z - 1, z + height_m};
}

Eigen::Vector2d Planting::somewhere(const Eigen::Vector2d& low, const Eigen::Vector2d& high) {
  return {site_.random.uniform(low.x(), high.x()), site_.random.uniform(low.y(), high.y())};
}

bool Planting::tree(const Eigen::Vector2d& at, double scale) {
  const TreeSize size = TreeSize::random(site_.random, scale);
  Footprint crown = standing(at, Eigen::Vector2d::Constant(size.crown_radius_m), 0, size.top_m());
  crown.low_m = ground_.height_m(at) + size.trunk_m - 0.2;
  const Footprint trunk = standing(at, Eigen::Vector2d::Constant(size.trunk_radius_m), 0, size.trunk_m);
  if (!site_.is_free(trunk, kGap_m) || !site_.take(crown, 0)) return false;
  site_.take(trunk, 0);
  add_tree(site_.mesh, site_.random, on_ground(at, 0), size);
  return true;
}

bool Planting::lamp_post(const Eigen::Vector2d& at, double yaw_rad) {
  if (!site_.take(standing(at, Eigen::Vector2d::Constant(kLampPostHalf_m), 0, kLampPostHeight_m), kGap_m)) return false;
  add_lamp_post(site_.mesh, site_.random, on_ground(at, yaw_rad));
  return true;
}

bool Planting::sign(const Eigen::Vector2d& at, double yaw_rad) {
  constexpr double kHalf_m = 0.4;
  if (!site_.take(standing(at, Eigen::Vector2d::Constant(kHalf_m), 0, 3.2), 0)) return false;
  add_sign(site_.mesh, site_.random, on_ground(at, yaw_rad));
  return true;
}

bool Planting::car(const Eigen::Vector2d& at, double yaw_rad) {
  if (!site_.take(standing(at, {kCarHalfLength_m, kCarHalfWidth_m}, yaw_rad, 1.8), 0.2)) return false;
  add_parked_car(site_.mesh, site_.random, on_ground(at, yaw_rad));
  return true;
}

bool Planting::hedge(const Eigen::Vector2d& at, double yaw_rad, double length_m) {
  constexpr double kWidth_m = 0.8;
  if (!site_.take(standing(at, {length_m / 2 + 0.3, kWidth_m / 2 + 0.2}, yaw_rad, 2), 0)) return false;
  add_hedge(site_.mesh, site_.random, on_ground(at, yaw_rad), length_m, kWidth_m);
  return true;
}

bool Planting::wall(const Eigen::Vector2d& at, double yaw_rad, double length_m, double height_m, Surface surface) {
  if (!site_.take(standing(at, {length_m / 2, 0.17}, yaw_rad, height_m), 0)) return false;
  add_wall(site_.mesh, on_ground(at, yaw_rad), length_m, height_m, surface);
  return true;
}

bool Planting::bench(const Eigen::Vector2d& at, double yaw_rad) {
  if (!site_.take(standing(at, {0.85, 0.35}, yaw_rad, 1), kGap_m)) return false;
  add_bench(site_.mesh, on_ground(at, yaw_rad));
  return true;
}

bool Planting::house(const House& wanted, double gap_m) {
  const Footprint print{wanted.centre, wanted.half_m, wanted.yaw_rad};
  Footprint with_balconies = print;
  with_balconies.half_m.array() += kBalcony_m;
  // Neighbours may touch; routes keep clear of the balconies too.
  if (!site_.is_free(print, gap_m) || !site_.is_off_routes(with_balconies)) return false;
  site_.take(print, gap_m);
  add_house(site_.mesh, site_.random, ground_, wanted);
  return true;
}

}  // namespace lxd::sim
