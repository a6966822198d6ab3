// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/world/mesh_builder.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

namespace lxd::sim {
namespace {

Eigen::Vector3d random_direction(Random& random) {
  const Eigen::Vector3d v{random.normal(), random.normal(), random.normal()};
  return v.normalized();
}

}  // namespace

Eigen::Vector3d Placement::at(double x, double y, double z) const {
  const double c = std::cos(yaw_rad);
  const double s = std::sin(yaw_rad);
  return foot_m + Eigen::Vector3d{c * x - s * y, s * x + c * y, z};
}

Placement Placement::moved(double x, double y, double z, double turn_rad) const {
  return {at(x, y, z), yaw_rad + turn_rad};
}

std::uint32_t MeshBuilder::add(std::span<const Eigen::Vector3d> corners) {
  const auto first = static_cast<std::uint32_t>(world_.vertices.size());
  for (const Eigen::Vector3d& corner : corners) world_.vertices.emplace_back(corner.cast<float>());
  return first;
}

void MeshBuilder::face(std::uint32_t a, std::uint32_t b, std::uint32_t c, Surface surface) {
  world_.faces.push_back({a, b, c});
  world_.face_material.push_back(static_cast<std::uint16_t>(surface));
}

void MeshBuilder::triangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                           Surface surface) {
  const std::uint32_t i = add(std::array{a, b, c});
  face(i, i + 1, i + 2, surface);
}

void MeshBuilder::quad(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
                       const Eigen::Vector3d& d, Surface surface) {
  const std::uint32_t i = add(std::array{a, b, c, d});
  face(i, i + 1, i + 2, surface);
  face(i, i + 2, i + 3, surface);
}

void MeshBuilder::hexahedron(const std::array<Eigen::Vector3d, 8>& corners, Surface surface) {
  // Corners of each side in turn around it, seen from outside.
  static constexpr std::array<std::array<std::uint32_t, 4>, 6> kSides{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  const std::uint32_t i = add(corners);
  for (const auto& [a, b, c, d] : kSides) {
    face(i + a, i + b, i + c, surface);
    face(i + a, i + c, i + d, surface);
  }
}

void MeshBuilder::box(const Placement& at, const Eigen::Vector3d& size_m, Surface surface) {
  std::array<Eigen::Vector3d, 8> corners;
  for (unsigned i = 0; i < corners.size(); ++i)
    corners[i] = at.at((i & 1U ? 0.5 : -0.5) * size_m.x(), (i & 2U ? 0.5 : -0.5) * size_m.y(), i & 4U ? size_m.z() : 0);
  hexahedron(corners, surface);
}

void MeshBuilder::block(const Eigen::Vector3d& low_m, const Eigen::Vector3d& high_m, Surface surface) {
  const Eigen::Vector3d middle = (low_m + high_m) / 2;
  box({{middle.x(), middle.y(), low_m.z()}, 0}, high_m - low_m, surface);
}

void MeshBuilder::cylinder(const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m, double from_radius_m,
                           double to_radius_m, int sides, Surface surface) {
  const Eigen::Vector3d axis = (to_m - from_m).normalized();
  const Eigen::Vector3d u = axis.unitOrthogonal();
  const Eigen::Vector3d v = axis.cross(u);
  const auto rim = [&](int i) -> Eigen::Vector3d {
    const double angle = 2 * std::numbers::pi * i / sides;
    return u * std::cos(angle) + v * std::sin(angle);
  };
  for (int i = 0; i < sides; ++i) {
    const Eigen::Vector3d a = rim(i);
    const Eigen::Vector3d b = rim(i + 1);
    quad(from_m + from_radius_m * a, from_m + from_radius_m * b, to_m + to_radius_m * b, to_m + to_radius_m * a,
         surface);
    triangle(to_m, to_m + to_radius_m * a, to_m + to_radius_m * b, surface);
    triangle(from_m, from_m + from_radius_m * b, from_m + from_radius_m * a, surface);
  }
}

void MeshBuilder::stairs(const Placement& at, double width_m, double run_m, double rise_m, int steps, Surface surface) {
  for (int i = 0; i < steps; ++i) box(at.moved((i + 0.5) * run_m, 0, 0), {run_m, width_m, (i + 1) * rise_m}, surface);
}

void MeshBuilder::leaves(Random& random, const Eigen::Vector3d& centre_m, const Eigen::Vector3d& radii_m, int count,
                         double size_m) {
  constexpr double kHollow = 0.15;  // of the volume: no leaves at the core
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d way = random_direction(random);
    const Eigen::Vector3d at = centre_m + std::cbrt(random.uniform(kHollow, 1)) * way.cwiseProduct(radii_m);
    const double size = size_m * random.uniform(0.6, 1.4);
    const Eigen::Vector3d u = size * random_direction(random);
    const Eigen::Vector3d v = size * random_direction(random);
    triangle(at, at + u, at + v, Surface::foliage);
  }
}

}  // namespace lxd::sim
