// SPDX-License-Identifier: Apache-2.0
// An image that colours are told from: small, without distortion, of a known place.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "rt/pose.hpp"
#include "rt/time.hpp"

namespace lxd {

// A camera without distortion. Camera frame: z forward, x right, y down; the centre of the upper left pixel is (0, 0).
struct PinholeView {
  int width = 0, height = 0;
  float focal_px = 1;
  Eigen::Vector2f centre_px = Eigen::Vector2f::Zero();

  [[nodiscard]] Eigen::Vector2f pixel(const Eigen::Vector3f& p_camera) const {
    return focal_px / p_camera.z() * p_camera.head<2>() + centre_px;
  }
  [[nodiscard]] std::size_t pixels() const {
    return static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  }
};

// A channel of this level says nothing: full wells, or off the camera's own image.
inline constexpr std::uint8_t kBlindLevel = 255;

struct KeyImage {
  RigTime stamp;                       // the middle of its exposure
  Pose T_world_camera;                 // in the filter's world, at that time
  double scene_m = 0;                  // from the LiDAR to half of what is around
  double turn_radps = 0;               // of the camera then: blur, and what the pose may be wrong by
  std::optional<double> log_exposure;  // of its time and gain, e-fold; where the camera told
  std::vector<std::uint8_t> rgb;       // rows of the view without gaps, sRGB
};

}  // namespace lxd
