// SPDX-License-Identifier: Apache-2.0
// The unit rays of all pixels, made once: the inverse of a distortion is iterative.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "tools/simulator/camera/camera_config.hpp"

namespace lxd::sim {

class RayTable {
 public:
  // Precondition: sees_everywhere(config).
  explicit RayTable(const CameraConfig& config);

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }
  [[nodiscard]] const Eigen::Vector3f& at(int u, int v) const { return rays_[index(u, v)]; }
  // Beside a pixel's centre, |du|, |dv| < 1; linear between pixels, which is within 0.001 pixels.
  [[nodiscard]] Eigen::Vector3f beside(int u, int v, float du, float dv) const;
  // The largest angle between neighbours.
  [[nodiscard]] float spread_rad() const { return spread_rad_; }

 private:
  // One more column and row than pixels: the last pixels have neighbours too.
  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width_ + 1) + static_cast<std::size_t>(u);
  }

  int width_, height_;
  float spread_rad_ = 0;
  std::vector<Eigen::Vector3f> rays_;
};

}  // namespace lxd::sim
