// SPDX-License-Identifier: Apache-2.0
// Uniform grid of triangles: two passes fill it (count, then place), shells of cells answer nearest, a 3-D DDA
// (Amanatides & Woo, Eurographics 1987) answers visibility.
#include "tools/evaluate/triangle_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

namespace lxd {
namespace {

// Moeller & Trumbore, 1997. True: the triangle is met at 0 < t < 1 of the step.
bool crosses(const Eigen::Vector3d& from, const Eigen::Vector3d& step, const std::array<Eigen::Vector3d, 3>& t) {
  constexpr double kParallel = 1e-12;
  const Eigen::Vector3d ab = t[1] - t[0];
  const Eigen::Vector3d ac = t[2] - t[0];
  const Eigen::Vector3d h = step.cross(ac);
  const double determinant = ab.dot(h);
  if (std::abs(determinant) < kParallel) return false;
  const Eigen::Vector3d s = from - t[0];
  const double u = s.dot(h) / determinant;
  const Eigen::Vector3d q = s.cross(ab);
  const double v = step.dot(q) / determinant;
  const double at = ac.dot(q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && at > 0 && at < 1;
}

}  // namespace

// Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
Eigen::Vector3d closest_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a;
  const double d1 = ab.dot(p - a), d2 = ac.dot(p - a);
  if (d1 <= 0 && d2 <= 0) return a;
  const double d3 = ab.dot(p - b), d4 = ac.dot(p - b);
  if (d3 >= 0 && d4 <= d3) return b;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0 && d1 >= 0 && d3 <= 0) return d1 > d3 ? (a + d1 / (d1 - d3) * ab).eval() : a;
  const double d5 = ab.dot(p - c), d6 = ac.dot(p - c);
  if (d6 >= 0 && d5 <= d6) return c;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0 && d2 >= 0 && d6 <= 0) return a + d2 / (d2 - d6) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) return b + (d4 - d3) / ((d4 - d3) + (d5 - d6)) * (c - b);
  return a + (vb * ab + vc * ac) / (va + vb + vc);
}

TriangleGrid::TriangleGrid(const TriangleMesh& mesh, double cell_m) : mesh_(mesh) {
  set_bounds(cell_m);
  fill();
}

void TriangleGrid::set_bounds(double cell_m) {
  cell_m_ = cell_m;
  if (mesh_.vertices_m.empty()) return;
  Eigen::Vector3d low = mesh_.vertices_m[0], high = low;
  for (const Eigen::Vector3d& v : mesh_.vertices_m) {
    low = low.cwiseMin(v);
    high = high.cwiseMax(v);
  }
  const auto cells = [&] { return ((high - low) / cell_m_).array() + 2; };
  constexpr double kGrowth = 1.25;
  while (cells().prod() > kCellsMax) cell_m_ *= kGrowth;
  size_ = cells().cast<int>();
  origin_ = low.array() - 0.5 * cell_m_;
}

TriangleGrid::Cell TriangleGrid::cell_of(const Eigen::Vector3d& p) const {
  return ((p - origin_) / cell_m_).array().floor().cwiseMax(-1e9).cwiseMin(1e9).cast<int>();
}

std::size_t TriangleGrid::index_of(const Cell& c) const {
  return (static_cast<std::size_t>(c.z()) * size_.y() + c.y()) * size_.x() + c.x();
}

std::span<const std::uint32_t> TriangleGrid::faces_in(const Cell& c) const {
  const std::size_t i = index_of(c);
  return std::span(faces_).subspan(begin_[i], begin_[i + 1] - begin_[i]);
}

std::array<Eigen::Vector3d, 3> TriangleGrid::corners(std::uint32_t face) const {
  const auto& f = mesh_.faces[face];
  return {mesh_.vertices_m[f[0]], mesh_.vertices_m[f[1]], mesh_.vertices_m[f[2]]};
}

// By the sphere around the cell: it may say yes too often, never too seldom.
bool TriangleGrid::touches(std::uint32_t face, const Cell& c) const {
  const Eigen::Vector3d centre = origin_ + cell_m_ * (c.cast<double>().array() + 0.5).matrix();
  const auto [a, b, d] = corners(face);
  return (closest_on_triangle(centre, a, b, d) - centre).norm() <= 0.5 * std::sqrt(3.0) * cell_m_;
}

template <typename Visit>
void TriangleGrid::for_each_touched(Visit visit) const {
  for (std::uint32_t face = 0; face < mesh_.faces.size(); ++face) {
    const auto [a, b, d] = corners(face);
    const Cell low = cell_of(a.cwiseMin(b).cwiseMin(d));
    const Cell high = cell_of(a.cwiseMax(b).cwiseMax(d));
    for (Cell c = low; c.z() <= high.z(); ++c.z())
      for (c.y() = low.y(); c.y() <= high.y(); ++c.y())
        for (c.x() = low.x(); c.x() <= high.x(); ++c.x())
          if (touches(face, c)) visit(index_of(c), face);
  }
}

void TriangleGrid::fill() {
  begin_.assign(static_cast<std::size_t>(size_.cast<std::int64_t>().prod()) + 1, 0);
  for_each_touched([this](std::size_t cell, std::uint32_t) { ++begin_[cell + 1]; });
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  faces_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for_each_touched([&](std::size_t cell, std::uint32_t face) { faces_[next[cell]++] = face; });
}

template <typename Visit>
void TriangleGrid::for_each_in_shell(const Cell& centre, int radius, Visit visit) const {
  Cell d;
  for (d.z() = -radius; d.z() <= radius; ++d.z())
    for (d.y() = -radius; d.y() <= radius; ++d.y()) {
      const bool on_side = std::max(std::abs(d.z()), std::abs(d.y())) == radius;
      for (d.x() = -radius; d.x() <= radius; d.x() += on_side ? 1 : std::max(2 * radius, 1))
        if (const Cell c = centre + d; inside(c)) std::ranges::for_each(faces_in(c), visit);
    }
}

double TriangleGrid::distance_m(const Eigen::Vector3d& p, double reach_m) const {
  const Cell centre = cell_of(p);
  double best_m = reach_m;
  for (int radius = 0; (radius - 1) * cell_m_ < best_m; ++radius)  // beyond, every cell is further than the best
    for_each_in_shell(centre, radius, [&](std::uint32_t face) {
      const auto [a, b, d] = corners(face);
      best_m = std::min(best_m, (closest_on_triangle(p, a, b, d) - p).norm());
    });
  return best_m;
}

bool TriangleGrid::crossed_in(const Cell& c, const Eigen::Vector3d& from, const Eigen::Vector3d& step) const {
  return inside(c) && std::ranges::any_of(faces_in(c), [&](auto face) { return crosses(from, step, corners(face)); });
}

bool TriangleGrid::hidden(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const {
  const double length_m = (to - from).norm();
  if (length_m <= kClearance_m) return false;
  const Eigen::Vector3d step = (to - from) * (1 - kClearance_m / length_m);
  const Cell last = cell_of(from + step);
  Cell c = cell_of(from);
  Eigen::Vector3d next;  // fraction of the step at which the next cell border of each axis is met
  Eigen::Vector3d stride;
  for (int axis = 0; axis < 3; ++axis) {
    const double border = origin_[axis] + cell_m_ * (c[axis] + (step[axis] > 0 ? 1 : 0));
    const bool moves = std::abs(step[axis]) > 1e-12;
    next[axis] = moves ? (border - from[axis]) / step[axis] : std::numeric_limits<double>::infinity();
    stride[axis] = moves ? cell_m_ / std::abs(step[axis]) : 0;
  }
  for (;;) {
    if (crossed_in(c, from, step)) return true;
    Eigen::Index axis = 0;
    if (c == last || next.minCoeff(&axis) > 1) return false;
    c[axis] += step[axis] > 0 ? 1 : -1;
    next[axis] += stride[axis];
  }
}

}  // namespace lxd
