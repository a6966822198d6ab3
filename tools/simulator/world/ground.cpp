// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/ground.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lxd::sim {

Relief::Relief(Random& random, double amplitude_m, double wavelength_m) {
  constexpr int kWaves = 5;
  if (amplitude_m == 0) return;
  for (int i = 0; i < kWaves; ++i) {
    const double direction = random.uniform(0, 2 * std::numbers::pi);
    const double phase = random.uniform(0, 2 * std::numbers::pi);
    const double shortened = 1 + 0.5 * i;
    const double radpm = 2 * std::numbers::pi * shortened / wavelength_m;
    waves_.push_back({radpm * Eigen::Vector2d{std::cos(direction), std::sin(direction)}, phase,
                      amplitude_m / (shortened * shortened * kWaves / 2)});
  }
}

double Relief::operator()(const Eigen::Vector2d& at) const {
  double height = 0;
  for (const Wave& wave : waves_) height += wave.amplitude_m * std::sin(wave.radpm.dot(at) + wave.phase_rad);
  return height;
}

Ground::Ground(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m, double cell_m, const Relief& relief)
    : low_m_(low_m),
      cell_m_(cell_m),
      columns_(static_cast<int>(std::ceil((high_m - low_m).x() / cell_m)) + 1),
      rows_(static_cast<int>(std::ceil((high_m - low_m).y() / cell_m)) + 1) {
  for (int j = 0; j < rows_; ++j)
    for (int i = 0; i < columns_; ++i) heights_m_.push_back(relief(low_m_ + cell_m_ * Eigen::Vector2d{i, j}));
}

double Ground::height_m(const Eigen::Vector2d& at) const {
  const Eigen::Vector2d cell = (at - low_m_) / cell_m_;
  const int i = std::clamp(static_cast<int>(std::floor(cell.x())), 0, columns_ - 2);
  const int j = std::clamp(static_cast<int>(std::floor(cell.y())), 0, rows_ - 2);
  const double u = std::clamp(cell.x() - i, 0.0, 1.0);
  const double v = std::clamp(cell.y() - j, 0.0, 1.0);
  if (u + v <= 1) return node(i, j) + u * (node(i + 1, j) - node(i, j)) + v * (node(i, j + 1) - node(i, j));
  const double far = node(i + 1, j + 1);
  return far + (1 - u) * (node(i, j + 1) - far) + (1 - v) * (node(i + 1, j) - far);
}

std::vector<Eigen::Vector3d> Ground::on(const Line& line, double above_m) const {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector2d& at : line) points.push_back(on(at, above_m));
  return points;
}

Eigen::Vector3d Ground::corner(int i, int j) const {
  const Eigen::Vector2d at = low_m_ + cell_m_ * Eigen::Vector2d{i, j};
  return {at.x(), at.y(), node(i, j)};
}

void Ground::add_to(MeshBuilder& mesh, const std::function<Surface(const Eigen::Vector2d&)>& surface_at) const {
  for (int j = 0; j + 1 < rows_; ++j) {
    for (int i = 0; i + 1 < columns_; ++i) {
      const Surface surface = surface_at(low_m_ + cell_m_ * Eigen::Vector2d{i + 0.5, j + 0.5});
      mesh.triangle(corner(i, j), corner(i + 1, j), corner(i, j + 1), surface);
      mesh.triangle(corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1), surface);
    }
  }
}

}  // namespace lxd::sim
