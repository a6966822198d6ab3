// SPDX-License-Identifier: Apache-2.0
// The cells of a cubic lattice that a ray passes, in order: three-dimensional digital differential analysis (Amanatides
// & Woo, A Fast Voxel Traversal Algorithm for Ray Tracing, 1987). Every crossing is computed from the lattice itself,
// not added up, so that long rays do not drift off it.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Core>

#include "mapping/lattice.hpp"

namespace lxd {

struct Ray {
  Eigen::Vector3d origin_m;   // world
  Eigen::Vector3d direction;  // unit
  double range_m;             // no farther than this

  [[nodiscard]] Eigen::Vector3d at(double along_m) const { return origin_m + along_m * direction; }
};

// Of numbers, unit length, and not so far that coordinates have no sound cell any more.
inline bool is_castable(const Ray& ray) {
  constexpr double kUnitTolerance = 1e-3, kFarthest_m = 1e5;
  const double reach = ray.origin_m.lpNorm<Eigen::Infinity>() + ray.range_m;
  return std::abs(ray.direction.squaredNorm() - 1) < kUnitTolerance && ray.range_m >= 0 && reach < kFarthest_m;
}

class LatticeWalk {
 public:
  // The part of the ray from begin_m to end_m. Precondition: finite, within the lattice's keys.
  LatticeWalk(const Ray& ray, double edge_m, double begin_m, double end_m)
      : origin_(ray.origin_m / edge_m), entry_m_(begin_m), end_m_(end_m) {
    index_ = cell_of(ray.at(begin_m), 1.0 / edge_m);
    for (int axis = 0; axis < 3; ++axis) {
      const double d = ray.direction[axis];
      step_[axis] = d > 0 ? 1 : d < 0 ? -1 : 0;
      inverse_[axis] = step_[axis] != 0 ? edge_m / d : 0.0;
      find_crossing(axis);
    }
  }

  [[nodiscard]] const CellIndex& index() const { return index_; }
  [[nodiscard]] double entry_m() const { return entry_m_; }  // along the ray
  [[nodiscard]] double exit_m() const { return std::min(crossing_m_.minCoeff(), end_m_); }

  // False: the ray ends in this cell.
  bool advance() {
    int axis = 0;
    const double next = crossing_m_.minCoeff(&axis);
    if (!(next < end_m_)) return false;
    entry_m_ = std::max(entry_m_, next);
    index_[axis] += step_[axis];
    find_crossing(axis);
    return true;
  }

 private:
  void find_crossing(int axis) {
    const int boundary = index_[axis] + (step_[axis] > 0 ? 1 : 0);
    crossing_m_[axis] =
        step_[axis] != 0 ? (boundary - origin_[axis]) * inverse_[axis] : std::numeric_limits<double>::infinity();
  }

  Eigen::Vector3d origin_;  // in edges
  double entry_m_, end_m_;
  CellIndex index_, step_;
  Eigen::Vector3d inverse_;     // m along the ray for one edge along the axis, with the direction's sign
  Eigen::Vector3d crossing_m_;  // where the ray leaves the cell by each axis
};

}  // namespace lxd
