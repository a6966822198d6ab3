// SPDX-License-Identifier: Apache-2.0
// Places for the loop tests: a square of ground with boxes at random, and corridors.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include <Eigen/Geometry>

#include "backend/loops/loop_finder.hpp"
#include "rt/so3.hpp"
#include "tests/support/synthetic_mesh.hpp"

namespace lxd::test {

inline constexpr float kTownHalf_m = 30;

// Ground at z = 0 and boxes, houses and low things, of its own for each seed.
inline SyntheticMesh town(std::uint32_t seed) {
  SyntheticMesh mesh;
  mesh.add_patch({-kTownHalf_m, -kTownHalf_m, 0}, {2 * kTownHalf_m, 0, 0}, {0, 2 * kTownHalf_m, 0}, 0.5F);
  std::mt19937 engine(seed);
  const auto uniform = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(engine() >> 8) / static_cast<float>(1U << 24);
  };
  for (int i = 0; i < 25; ++i) {
    const Eigen::Vector3f low(uniform(-28, 22), uniform(-28, 22), 0);
    const Eigen::Vector3f size(uniform(1, 6), uniform(1, 6), uniform(0.8F, 7));
    const bool on_the_way = low.x() < 4 && low.x() + size.x() > -4 && low.y() < 4 && low.y() + size.y() > -4;
    if (!on_the_way) mesh.add_box(low, size);
  }
  return mesh;
}

// 60 m of smooth walls along x, 3 m apart: nothing holds the position along them.
inline SyntheticMesh corridor() {
  SyntheticMesh mesh;
  mesh.add_patch({-30, -1.5F, 0}, {60, 0, 0}, {0, 3, 0});
  mesh.add_patch({-30, -1.5F, 0}, {0, 0, 3}, {60, 0, 0});
  mesh.add_patch({-30, 1.5F, 0}, {60, 0, 0}, {0, 0, 3});
  return mesh;
}

inline std::vector<MeshVertex> moved(const std::vector<MeshVertex>& vertices, const Pose& T) {
  std::vector<MeshVertex> out = vertices;
  for (MeshVertex& v : out) {
    v.position_m = (T * v.position_m.cast<double>()).cast<float>();
    v.normal = T.R.cast<float>() * v.normal;
  }
  return out;
}

inline Pose level_pose(double yaw_rad, double x_m, double y_m, double z_m = 0) {
  return {Exp(Eigen::Vector3d(0, 0, yaw_rad)), {x_m, y_m, z_m}};
}

// What stands in the half-plane ahead of the origin.
inline std::vector<MeshVertex> front_of(const std::vector<MeshVertex>& vertices) {
  std::vector<MeshVertex> out;
  for (const MeshVertex& v : vertices)
    if (v.position_m.x() > 0) out.push_back(v);
  return out;
}

}  // namespace lxd::test
