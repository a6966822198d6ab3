// SPDX-License-Identifier: Apache-2.0
// A uniform grid over a triangle mesh that answers: how far is the nearest surface, and is something in the way.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "tools/evaluate/triangle_mesh.hpp"

namespace lxd {

Eigen::Vector3d closest_on_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                    const Eigen::Vector3d& c);

class TriangleGrid {
 public:
  // Keeps a reference to the mesh. Cells are cell_m wide, or wider where the mesh would take more than kCellsMax.
  static constexpr double kCellsMax = 4e6;
  explicit TriangleGrid(const TriangleMesh& mesh, double cell_m = 0.25);

  // Distance in m to the nearest triangle; `reach_m` when there is none nearer than that.
  [[nodiscard]] double distance_m(const Eigen::Vector3d& p, double reach_m) const;

  // True when a triangle crosses the open segment from `from` to `to`, kClearance_m before its end at the latest: what
  // `to` lies on does not hide it.
  static constexpr double kClearance_m = 0.01;
  [[nodiscard]] bool hidden(const Eigen::Vector3d& from, const Eigen::Vector3d& to) const;

 private:
  using Cell = Eigen::Vector3i;
  [[nodiscard]] Cell cell_of(const Eigen::Vector3d& p) const;
  [[nodiscard]] bool inside(const Cell& c) const { return (c.array() >= 0).all() && (c.array() < size_.array()).all(); }
  [[nodiscard]] std::size_t index_of(const Cell& c) const;
  [[nodiscard]] std::span<const std::uint32_t> faces_in(const Cell& c) const;
  [[nodiscard]] std::array<Eigen::Vector3d, 3> corners(std::uint32_t face) const;
  [[nodiscard]] bool touches(std::uint32_t face, const Cell& c) const;
  void set_bounds(double cell_m);
  void fill();
  template <typename Visit>
  void for_each_touched(Visit visit) const;  // visit(cell index, face)
  template <typename Visit>
  void for_each_in_shell(const Cell& centre, int radius, Visit visit) const;  // visit(face)
  [[nodiscard]] bool crossed_in(const Cell& c, const Eigen::Vector3d& from, const Eigen::Vector3d& step) const;

  const TriangleMesh& mesh_;
  Eigen::Vector3d origin_ = Eigen::Vector3d::Zero();
  Cell size_ = Cell::Zero();
  double cell_m_ = 1;
  std::vector<std::uint32_t> begin_;  // of each cell in faces_, and the end of the last
  std::vector<std::uint32_t> faces_;
};

}  // namespace lxd
