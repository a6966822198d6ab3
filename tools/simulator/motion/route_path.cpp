// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/motion/route_path.hpp"

#include <algorithm>
#include <cmath>

#include "tools/simulator/motion/smooth.hpp"

namespace lxd::sim {
namespace {

using Eigen::Vector3d;

constexpr std::ptrdiff_t kWidest = 10;   // half width of the running means that round as far as they may
constexpr double kClearanceShare = 0.6;  // of the clearance for rounding; the rest is the body's to sway
constexpr double kSame_m = 1e-6;

// Without repeated points; a closed way ends where it began.
std::vector<Vector3d> cleaned(const Route& route) {
  std::vector<Vector3d> way;
  for (const Vector3d& point : route.way_m)
    if (way.empty() || (point - way.back()).norm() > kSame_m) way.push_back(point);
  if (route.closed && way.size() > 1 && (way.front() - way.back()).norm() > kSame_m) way.push_back(way.front());
  return way;
}

double length_of(const std::vector<Vector3d>& way) {
  double length = 0;
  for (std::size_t i = 1; i < way.size(); ++i) length += (way[i] - way[i - 1]).norm();
  return length;
}

// Points along the way, count + 1 of them, evenly spaced.
std::vector<Vector3d> resampled(const std::vector<Vector3d>& way, std::size_t count) {
  const double step = length_of(way) / static_cast<double>(count);
  std::vector<Vector3d> points;
  std::size_t leg = 0;
  double leg_begin = 0;
  for (std::size_t i = 0; i <= count; ++i) {
    const double u = static_cast<double>(i) * step;
    while (leg + 2 < way.size() && u > leg_begin + (way[leg + 1] - way[leg]).norm()) {
      leg_begin += (way[leg + 1] - way[leg]).norm();
      ++leg;
    }
    points.push_back(way[leg] + (u - leg_begin) * (way[leg + 1] - way[leg]).normalized());
  }
  return points;
}

// The value at any index: round and round, or mirrored through the ends, which then stay where they are.
Vector3d beyond(const std::vector<Vector3d>& points, bool closed, std::ptrdiff_t i) {
  const auto last = static_cast<std::ptrdiff_t>(points.size()) - 1;
  if (closed) return points[((i % last) + last) % last];
  if (i < 0) return 2 * points.front() - points[std::min(-i, last)];
  if (i > last) return 2 * points.back() - points[std::max<std::ptrdiff_t>(2 * last - i, 0)];
  return points[i];
}

std::vector<Vector3d> padded(const std::vector<Vector3d>& points, bool closed, std::ptrdiff_t before,
                             std::ptrdiff_t after) {
  std::vector<Vector3d> result;
  for (std::ptrdiff_t i = -before; i < static_cast<std::ptrdiff_t>(points.size()) + after; ++i)
    result.push_back(beyond(points, closed, i));
  return result;
}

std::vector<Vector3d> smoothed(const std::vector<Vector3d>& points, bool closed, std::ptrdiff_t half_width) {
  const std::ptrdiff_t reach = kSmoothPasses * half_width;
  std::vector<Vector3d> wide = padded(points, closed, reach, reach);
  smooth<Vector3d>(wide, half_width, Vector3d::Zero());
  return {wide.begin() + reach, wide.end() - reach};
}

double furthest(const std::vector<Vector3d>& a, const std::vector<Vector3d>& b) {
  double furthest = 0;
  for (std::size_t i = 0; i < a.size(); ++i) furthest = std::max(furthest, (a[i] - b[i]).norm());
  return furthest;
}

std::size_t cells_of(double length_m, double corner_m) {
  return static_cast<std::size_t>(std::max(2.0 * kWidest, std::ceil(length_m * kSmoothPasses * kWidest / corner_m)));
}

}  // namespace

double route_length_m(const Route& route) { return length_of(cleaned(route)); }

bool has_heading(const Vector3d& along) {
  constexpr double kSteep = 0.2;  // horizontal part of the direction
  return std::hypot(along.x(), along.y()) > kSteep * along.norm();
}

double RoutePath::Point::bend_per_m() const {
  const double pace = std::hypot(d1.x(), d1.y());
  return pace < kSame_m ? 0 : (d1.x() * d2.y() - d1.y() * d2.x()) / (pace * pace * pace);
}

RoutePath::RoutePath(const Route& route, double corner_m) : RoutePath(route, cleaned(route), corner_m) {}

RoutePath::RoutePath(const Route& route, std::vector<Vector3d> way, double corner_m)
    : closed_(route.closed), length_m_(length_of(way)), curve_(0, 1, {}, {}) {
  const std::size_t cells = cells_of(length_m_, corner_m);
  const std::vector<Vector3d> points = resampled(way, cells);
  std::vector<Vector3d> round;
  for (std::ptrdiff_t half_width = kWidest; half_width > 0; --half_width) {
    round = smoothed(points, closed_, half_width);
    deviation_m_ = furthest(points, round);
    if (deviation_m_ <= kClearanceShare * route.clearance_m) break;
  }
  curve_ = rounded(round, closed_, length_m_ / static_cast<double>(cells));
}

Trajectory RoutePath::rounded(const std::vector<Vector3d>& points, bool closed, double step_m) {
  const std::vector<Vector3d> controls = padded(points, closed, Trajectory::kBefore, Trajectory::kAfter);
  return {-Trajectory::kBefore * step_m, step_m, controls,
          std::vector<Eigen::Quaterniond>(controls.size(), Eigen::Quaterniond::Identity())};
}

RoutePath::Point RoutePath::at(double u_m) const {
  const double u = closed_ ? u_m - length_m_ * std::floor(u_m / length_m_) : std::clamp(u_m, 0.0, length_m_);
  const MotionState state = curve_.at(std::clamp(u, curve_.begin_s(), curve_.end_s()));
  return {state.T_world_body.p, state.v_world_mps, state.a_world_mps2};
}

}  // namespace lxd::sim
