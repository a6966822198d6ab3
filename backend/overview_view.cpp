// SPDX-License-Identifier: Apache-2.0
// Fitting of the overview's projections.
#include "backend/overview_view.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace lxd {
namespace {

constexpr double kOutlierShare = 0.005;  // of the vertices, at either end
constexpr double kSpanMin_m = 4;         // a room
constexpr double kMargin = 1.06;

std::vector<double> along(std::span<const Eigen::Vector3d> points_m, const Eigen::Vector3d& axis) {
  std::vector<double> values;
  values.reserve(points_m.size());
  for (const Eigen::Vector3d& p : points_m) values.push_back(axis.dot(p));
  return values;
}

Interval united(const Interval& a, const Interval& b) { return {std::min(a.low, b.low), std::max(a.high, b.high)}; }

Interval extent(const Eigen::Vector3d& axis, std::span<const Eigen::Vector3d> points_m,
                std::span<const Eigen::Vector3d> path_m) {
  const Interval points = inner_interval(along(points_m, axis), kOutlierShare);
  const Interval path = inner_interval(along(path_m, axis), 0);
  if (points_m.empty()) return path;
  return path_m.empty() ? points : united(points, path);
}

}  // namespace

Interval inner_interval(std::vector<double> values, double fraction) {
  if (values.empty()) return {};
  const auto last = static_cast<double>(values.size() - 1);
  const auto at = [&](double rank) {
    const auto nth = values.begin() + static_cast<std::ptrdiff_t>(rank);
    std::ranges::nth_element(values, nth);
    return *nth;
  };
  const double low = at(std::floor(fraction * last));
  return {low, at(std::ceil((1 - fraction) * last))};
}

Eigen::Matrix3d look(double heading_rad, double elevation_rad) {
  const Eigen::Vector3d forward(std::cos(heading_rad), std::sin(heading_rad), 0);
  const Eigen::Vector3d right(std::sin(heading_rad), -std::cos(heading_rad), 0);
  const Eigen::Vector3d up = std::sin(elevation_rad) * forward + std::cos(elevation_rad) * Eigen::Vector3d::UnitZ();
  Eigen::Matrix3d R;
  R << right.transpose(), up.transpose(), right.cross(up).transpose();
  return R;
}

double main_heading(std::span<const Eigen::Vector3d> points_m) {
  if (points_m.empty()) return 0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const Eigen::Vector3d& p : points_m) mean += p.head<2>() / static_cast<double>(points_m.size());
  Eigen::Matrix2d scatter = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector3d& p : points_m) scatter += (p.head<2>() - mean) * (p.head<2>() - mean).transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(scatter);
  Eigen::Vector2d longest = axes.eigenvectors().col(1);
  if (longest.x() + longest.y() < 0) longest = -longest;
  return std::atan2(longest.x(), -longest.y());  // a quarter turn left of the longer side
}

View fit_view(const Eigen::Matrix3d& R_view_map, std::span<const Eigen::Vector3d> points_m,
              std::span<const Eigen::Vector3d> path_m, const Eigen::Vector2d& centre_px,
              const Eigen::Vector2d& size_px) {
  const Interval across = extent(R_view_map.row(0).transpose(), points_m, path_m);
  const Interval upward = extent(R_view_map.row(1).transpose(), points_m, path_m);
  const Eigen::Vector2d span_m(std::max(across.high - across.low, kSpanMin_m),
                               std::max(upward.high - upward.low, kSpanMin_m));
  View view;
  view.R_view_map = R_view_map;
  view.pixels_per_m = (size_px.array() / (kMargin * span_m).array()).minCoeff();
  view.centre_m = 0.5 * Eigen::Vector2d(across.low + across.high, upward.low + upward.high);
  view.centre_px = centre_px;
  return view;
}

}  // namespace lxd
