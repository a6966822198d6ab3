// SPDX-License-Identifier: Apache-2.0
// Worlds for a simulated camera's tests: walls of squares across the x axis, a camera that looks along it.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Geometry>

#include "rt/pose.hpp"
#include "tools/simulator/motion/trajectory.hpp"
#include "tools/simulator/world/world.hpp"

namespace lxd::test {

inline sim::World two_tone_world() {
  sim::World world;
  world.materials = {{.name = "dark", .albedo = 0.15F, .contrast = 0},
                     {.name = "bright", .albedo = 0.75F, .contrast = 0}};
  return world;
}

// The square [y, y + side] x [z, z + side] of the plane at x.
inline void add_square(sim::World& world, float x_m, float y_m, float z_m, float side_m, std::uint16_t material) {
  const auto first = static_cast<std::uint32_t>(world.vertices.size());
  for (const auto& [dy, dz] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
    world.vertices.emplace_back(x_m, y_m + static_cast<float>(dy) * side_m, z_m + static_cast<float>(dz) * side_m);
  }
  world.faces.push_back({first, first + 1, first + 2});
  world.faces.push_back({first, first + 2, first + 3});
  world.face_material.insert(world.face_material.end(), 2, material);
}

// count x count squares around the axis, dark and bright in turn.
inline sim::World checkerboard(float x_m, float side_m, int count) {
  sim::World world = two_tone_world();
  const float begin_m = -side_m * static_cast<float>(count) / 2;
  for (int i = 0; i < count; ++i) {
    for (int k = 0; k < count; ++k) {
      add_square(world, x_m, begin_m + side_m * static_cast<float>(i), begin_m + side_m * static_cast<float>(k), side_m,
                 static_cast<std::uint16_t>((i + k) % 2));
    }
  }
  return world;
}

// Camera z along the body's x, camera x along the body's -y.
inline Pose forward_camera() {
  Pose T_body_camera;
  T_body_camera.R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return T_body_camera;
}

// From the origin at constant velocity and turn rate, for t_s in -1 .. 9 and beyond.
inline sim::Trajectory steady_motion(const Eigen::Vector3d& v_mps, const Eigen::Vector3d& omega_radps) {
  constexpr double kBegin_s = -3, kStep_s = 0.1;
  constexpr int kKnots = 150;
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Quaterniond> rotations;
  for (int i = 0; i < kKnots; ++i) {
    const double t_s = kBegin_s + kStep_s * i;
    positions.emplace_back(v_mps * t_s);
    const Eigen::AngleAxisd turned(omega_radps.norm() * t_s, omega_radps.stableNormalized());
    rotations.emplace_back(omega_radps.isZero() ? Eigen::Quaterniond::Identity() : Eigen::Quaterniond(turned));
  }
  return {kBegin_s, kStep_s, positions, rotations};
}

}  // namespace lxd::test
