// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/site.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lxd::sim {
namespace {

constexpr double kSample_m = 0.25;
const Eigen::Vector3f kPersonHalf_m{0.16F, 0.26F, 0.87F};
const Eigen::Vector3f kVehicleHalf_m{2.15F, 0.9F, 0.75F};

Eigen::Vector2d turned(const Eigen::Vector2d& v, double yaw_rad) {
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  return {c * v.x() - s * v.y(), s * v.x() + c * v.y()};
}

std::vector<Eigen::Vector3d> densely(std::span<const Eigen::Vector3d> way_m, bool closed) {
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i + (closed ? 0 : 1) < way_m.size(); ++i) {
    const Eigen::Vector3d step = way_m[(i + 1) % way_m.size()] - way_m[i];
    const int steps = std::max(1, static_cast<int>(std::ceil(step.norm() / kSample_m)));
    for (int k = 0; k < steps; ++k) points.emplace_back(way_m[i] + step * k / steps);
  }
  points.push_back(way_m.back());
  return points;
}

std::vector<Eigen::Vector3f> lifted(const std::vector<Eigen::Vector3d>& way_m, float by_m) {
  std::vector<Eigen::Vector3f> points;
  for (const Eigen::Vector3d& point : way_m) points.emplace_back(point.cast<float>() + by_m * Eigen::Vector3f::UnitZ());
  return points;
}

}  // namespace

double Footprint::distance_m(const Eigen::Vector2d& point) const {
  const Eigen::Vector2d local = turned(point - centre, -yaw_rad);
  return (local.cwiseAbs() - half_m).cwiseMax(0.0).norm();
}

bool Footprint::meets(const Footprint& other, double gap_m) const {
  if (low_m > other.high_m || high_m < other.low_m) return false;
  const Eigen::Vector2d between = other.centre - centre;
  if (between.norm() > half_m.norm() + other.half_m.norm() + gap_m) return false;
  const std::array<Eigen::Vector2d, 2> mine{turned(Eigen::Vector2d::UnitX(), yaw_rad),
                                            turned(Eigen::Vector2d::UnitY(), yaw_rad)};
  const std::array<Eigen::Vector2d, 2> theirs{turned(Eigen::Vector2d::UnitX(), other.yaw_rad),
                                              turned(Eigen::Vector2d::UnitY(), other.yaw_rad)};
  for (const Eigen::Vector2d& axis : {mine[0], mine[1], theirs[0], theirs[1]}) {
    const double reach = half_m.x() * std::abs(axis.dot(mine[0])) + half_m.y() * std::abs(axis.dot(mine[1])) +
                         other.half_m.x() * std::abs(axis.dot(theirs[0])) +
                         other.half_m.y() * std::abs(axis.dot(theirs[1]));
    if (std::abs(axis.dot(between)) > reach + gap_m) return false;
  }
  return true;
}

Site::Site(std::string_view name, std::uint64_t seed) : mesh(world), random(seed, name) {
  world.name = name;
  world.materials = standard_materials();
}

void Site::keep_clear(std::span<const Eigen::Vector3d> way_m, bool closed, const Room& room) {
  KeepClear keep{densely(way_m, closed), way_m.front().head<2>(), way_m.front().head<2>(), room};
  for (const Eigen::Vector3d& point : keep.points_m) {
    keep.low_m = keep.low_m.cwiseMin(point.head<2>());
    keep.high_m = keep.high_m.cwiseMax(point.head<2>());
  }
  keep_clear_.push_back(std::move(keep));
}

void Site::add_route(Route route, const Room& room) {
  keep_clear(route.way_m, route.closed, room);
  world.routes.push_back(std::move(route));
}

bool Site::blocks(const Footprint& wanted, const KeepClear& keep) {
  const double reach = wanted.half_m.norm() + keep.room.beside_m;
  if (((wanted.centre - keep.low_m).array() < -reach).any() || ((wanted.centre - keep.high_m).array() > reach).any())
    return false;
  return std::ranges::any_of(keep.points_m, [&](const Eigen::Vector3d& p) {
    return (p.head<2>() - wanted.centre).squaredNorm() < reach * reach && p.z() - keep.room.below_m < wanted.high_m &&
           p.z() + keep.room.above_m > wanted.low_m && wanted.distance_m(p.head<2>()) < keep.room.beside_m;
  });
}

bool Site::is_free(const Footprint& wanted, double gap_m) const {
  return std::ranges::none_of(taken_, [&](const Footprint& other) { return wanted.meets(other, gap_m); }) &&
         is_off_routes(wanted);
}

bool Site::is_off_routes(const Footprint& wanted) const {
  return std::ranges::none_of(keep_clear_, [&](const KeepClear& keep) { return blocks(wanted, keep); });
}

bool Site::take(const Footprint& wanted, double gap_m) {
  if (!is_free(wanted, gap_m)) return false;
  taken_.push_back(wanted);
  return true;
}

void Site::add_walker(std::vector<Eigen::Vector3d> way_m, double start_m) {
  const auto speed = static_cast<float>(random.uniform(0.7, 1.5));
  world.movers.push_back({kPersonHalf_m, static_cast<std::uint16_t>(Surface::person), lifted(way_m, kPersonHalf_m.z()),
                          speed, static_cast<float>(start_m)});
}

void Site::add_driver(std::vector<Eigen::Vector3d> way_m, double speed_mps, double start_m) {
  world.movers.push_back({kVehicleHalf_m, static_cast<std::uint16_t>(Surface::vehicle),
                          lifted(way_m, kVehicleHalf_m.z() + 0.1F), static_cast<float>(speed_mps),
                          static_cast<float>(start_m)});
}

}  // namespace lxd::sim
