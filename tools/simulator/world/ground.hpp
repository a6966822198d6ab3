// SPDX-License-Identifier: Apache-2.0
// Relief: a grid of heights, the same triangles for the mesh and for whoever stands on it.
#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

#include "tools/simulator/world/mesh_builder.hpp"
#include "tools/simulator/world/route_shape.hpp"

namespace lxd::sim {

// Gentle waves of random direction and phase.
class Relief {
 public:
  // amplitude_m: of the sum; the longest wave has wavelength_m, the shortest about a third of it. 0 is a plane.
  Relief(Random& random, double amplitude_m, double wavelength_m);
  [[nodiscard]] double operator()(const Eigen::Vector2d& at) const;

 private:
  struct Wave {
    Eigen::Vector2d radpm;
    double phase_rad;
    double amplitude_m;
  };
  std::vector<Wave> waves_;
};

class Ground {
 public:
  Ground(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m, double cell_m, const Relief& relief);

  // On the triangles of add_to().
  [[nodiscard]] double height_m(const Eigen::Vector2d& at) const;
  [[nodiscard]] Eigen::Vector3d on(const Eigen::Vector2d& at, double above_m = 0) const {
    return {at.x(), at.y(), height_m(at) + above_m};
  }
  [[nodiscard]] std::vector<Eigen::Vector3d> on(const Line& line, double above_m = 0) const;

  // surface_at: of a cell's middle.
  void add_to(MeshBuilder& mesh, const std::function<Surface(const Eigen::Vector2d&)>& surface_at) const;
  [[nodiscard]] const Eigen::Vector2d& low_m() const { return low_m_; }
  [[nodiscard]] Eigen::Vector2d high_m() const { return low_m_ + cell_m_ * Eigen::Vector2d{columns_ - 1, rows_ - 1}; }

 private:
  [[nodiscard]] double node(int i, int j) const { return heights_m_[static_cast<std::size_t>(j * columns_ + i)]; }
  [[nodiscard]] Eigen::Vector3d corner(int i, int j) const;

  Eigen::Vector2d low_m_;
  double cell_m_;
  int columns_;
  int rows_;
  std::vector<double> heights_m_;
};

}  // namespace lxd::sim
