// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/route_shape.hpp"

#include <algorithm>
#include <cmath>

namespace lxd::sim {
namespace {

constexpr double kStraight_rad = 1e-3;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() * b.y() - a.y() * b.x(); }

// Points strictly after `from` up to and with `to`.
void add_straight(Line& line, const Eigen::Vector2d& from, const Eigen::Vector2d& to, double step_m) {
  const int steps = std::max(1, static_cast<int>(std::ceil((to - from).norm() / step_m)));
  if ((to - from).norm() < 1e-6) return;
  for (int i = 1; i <= steps; ++i) line.push_back(from + (to - from) * i / steps);
}

struct Corner {
  Eigen::Vector2d enter, leave;  // where the arc begins and ends
  double turn_rad = 0;           // to the left
  double radius_m = 0;
};

Corner corner_of(const Eigen::Vector2d& before, const Eigen::Vector2d& at, const Eigen::Vector2d& after,
                 double radius_m) {
  const Eigen::Vector2d in = (at - before).normalized();
  const Eigen::Vector2d out = (after - at).normalized();
  const double turn = std::atan2(cross(in, out), in.dot(out));
  const double tangent = std::tan(std::abs(turn) / 2);
  const double room_m = 0.5 * std::min((at - before).norm(), (after - at).norm());
  if (std::abs(turn) < kStraight_rad) return {at, at, 0, 0};
  const double cut_m = std::min(room_m, radius_m * tangent);
  return {at - cut_m * in, at + cut_m * out, turn, cut_m / tangent};
}

void add_arc(Line& line, const Corner& corner, const Eigen::Vector2d& in, double step_m) {
  if (corner.turn_rad == 0) return;
  const double side = corner.turn_rad > 0 ? 1 : -1;
  const Eigen::Vector2d centre = corner.enter + side * corner.radius_m * Eigen::Vector2d{-in.y(), in.x()};
  const int steps = std::max(2, static_cast<int>(std::ceil(std::abs(corner.turn_rad) * corner.radius_m / step_m)));
  const Eigen::Vector2d arm = corner.enter - centre;
  for (int i = 1; i <= steps; ++i) {
    const double angle = corner.turn_rad * i / steps;
    line.push_back(centre + Eigen::Vector2d{std::cos(angle) * arm.x() - std::sin(angle) * arm.y(),
                                            std::sin(angle) * arm.x() + std::cos(angle) * arm.y()});
  }
}

}  // namespace

Line rounded(std::span<const Eigen::Vector2d> corners, double radius_m, double step_m, bool closed) {
  const std::size_t n = corners.size();
  Line line;
  Eigen::Vector2d last = corners.front();
  if (closed) last = corner_of(corners[n - 1], corners[0], corners[1], radius_m).leave;
  line.push_back(last);
  const std::size_t end = closed ? n + 1 : n;
  for (std::size_t i = 1; i < end; ++i) {
    const Eigen::Vector2d& at = corners[i % n];
    if (!closed && i + 1 == n) {
      add_straight(line, last, at, step_m);
      break;
    }
    const Eigen::Vector2d& before = corners[i - 1];
    const Corner corner = corner_of(before, at, corners[(i + 1) % n], radius_m);
    add_straight(line, last, corner.enter, step_m);
    add_arc(line, corner, (at - before).normalized(), step_m);
    last = corner.leave;
  }
  if (closed) line.pop_back();
  return line;
}

Line rectangle(const Eigen::Vector2d& centre, const Eigen::Vector2d& half_m) {
  const auto at = [&](double x, double y) -> Eigen::Vector2d {
    return centre + Eigen::Vector2d{x * half_m.x(), y * half_m.y()};
  };
  return {at(-1, -1), at(1, -1), at(1, 1), at(-1, 1)};
}

double length_m(std::span<const Eigen::Vector2d> line, bool closed) {
  double length = closed ? (line.front() - line.back()).norm() : 0;
  for (std::size_t i = 1; i < line.size(); ++i) length += (line[i] - line[i - 1]).norm();
  return length;
}

double LinePoint::yaw_rad() const { return std::atan2(along.y(), along.x()); }

LinePoint point_at(std::span<const Eigen::Vector2d> line, double s_m, bool closed) {
  if (closed) {
    const double length = length_m(line, true);
    s_m -= length * std::floor(s_m / length);
  }
  const std::size_t segments = closed ? line.size() : line.size() - 1;
  for (std::size_t i = 0; i < segments; ++i) {
    const Eigen::Vector2d step = line[(i + 1) % line.size()] - line[i];
    if (s_m <= step.norm() || i + 1 == segments) return {line[i] + s_m * step.normalized(), step.normalized()};
    s_m -= step.norm();
  }
  return {line.front(), Eigen::Vector2d::UnitX()};
}

Line beside(std::span<const Eigen::Vector2d> closed_line, double left_m) {
  const std::size_t n = closed_line.size();
  Line line;
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d along = (closed_line[(i + 1) % n] - closed_line[(i + n - 1) % n]).normalized();
    line.push_back(LinePoint{closed_line[i], along}.left(left_m));
  }
  return line;
}

}  // namespace lxd::sim
