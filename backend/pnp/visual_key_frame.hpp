// SPDX-License-Identifier: Apache-2.0
// What a key frame keeps of an image, for finding its place again by sight.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "rt/pose.hpp"

namespace lxd {

using OrbDescriptor = std::array<std::uint8_t, 32>;

// Of a mature feature: its distance is known, so that it is 3D and 2D at once. Without a distance it is 2D alone.
struct VisualFeature {
  OrbDescriptor descriptor{};
  Eigen::Vector3f bearing = Eigen::Vector3f::UnitZ();  // unit, camera frame, z forward and positive
  float sigma_rad = 0.003F;                            // of the bearing, either way across it
  float distance_m = 0;                                // along the bearing; 0: not known
  float distance_sigma_m = 0;

  [[nodiscard]] bool has_point() const { return distance_m > 0; }
  [[nodiscard]] Eigen::Vector3d point_m() const { return (distance_m * bearing).cast<double>(); }
};

struct VisualKeyFrame {
  std::int64_t id = 0;
  Pose T_body_camera;
  std::vector<VisualFeature> features;
};

}  // namespace lxd
