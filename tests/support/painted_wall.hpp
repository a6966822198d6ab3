// SPDX-License-Identifier: Apache-2.0
// A painted wall with a red box before it, and a camera's images of both: what colours are told from, and what they
// should be.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "backend/colour/colourist.hpp"
#include "backend/colour/srgb.hpp"
#include "tests/support/synthetic_mesh.hpp"

namespace lxd::test {

// The wall is the plane x = 5 m; the camera looks along x.
class PaintedWall {
 public:
  static constexpr float kWall_m = 5, kBox_m = 4.6F, kHalfBox_m = 0.5F, kSpacing_m = 0.1F;

  PaintedWall() {
    mesh_.add_patch({kWall_m, -4, -2}, {0, 0, 4}, {0, 8, 0}, kSpacing_m);
    wall_vertices_ = mesh_.vertices.size();
    const float side = 2 * kHalfBox_m;
    mesh_.add_patch({kBox_m, -kHalfBox_m, -kHalfBox_m}, {0, 0, side}, {0, side, 0}, kSpacing_m);
  }

  static PinholeView view() { return {160, 120, 100, {79.5F, 59.5F}}; }
  static SightLimits limits() { return {40, kSpacing_m}; }

  [[nodiscard]] const SyntheticMesh& mesh() const { return mesh_; }
  [[nodiscard]] std::size_t wall_vertices() const { return wall_vertices_; }

  static Eigen::Array3f box_light() { return {0.5F, 0.02F, 0.02F}; }
  static Eigen::Array3f wall_light(const Eigen::Vector3f& p) {
    return {0.10F + 0.05F * std::sin(2 * p.y()), 0.25F + 0.10F * std::sin(1.5F * p.z() + p.y()),
            0.30F + 0.15F * std::cos(1.2F * p.y())};
  }

  // From (0, y, 0), `gain` times as bright, darker by `falloff` (e-fold) in its corners.
  [[nodiscard]] static KeyImage image(int number, float y_m, float gain = 1, float falloff = 0) {
    KeyImage image;
    image.stamp = RigTime::from_ns(number);
    image.T_world_camera.R << 0, 0, 1, -1, 0, 0, 0, -1, 0;
    image.T_world_camera.p = {0, y_m, 0};
    const PinholeView seen = view();
    for (int v = 0; v < seen.height; ++v)
      for (int u = 0; u < seen.width; ++u) {
        const Eigen::Vector2f pixel(static_cast<float>(u), static_cast<float>(v));
        const float radius = (pixel - seen.centre_px).norm() / Eigen::Vector2f(80.5F, 60.5F).norm();
        const Eigen::Array3f light = gain * std::exp(-falloff * radius * radius) * light_at(pixel, y_m);
        for (int c = 0; c < 3; ++c) image.rgb.push_back(std::min<std::uint8_t>(level_of(light[c]), 254));
      }
    return image;
  }

  // Seven places on a line, half a metre apart.
  template <typename MakeImage>
  [[nodiscard]] static std::vector<KeyImage> images(const MakeImage& make) {
    std::vector<KeyImage> images;
    for (int i = 0; i < 7; ++i) images.push_back(make(i, 0.5F * static_cast<float>(i - 3)));
    return images;
  }

 private:
  static Eigen::Array3f light_at(const Eigen::Vector2f& pixel, float y_m) {
    const Eigen::Vector2f bent = (pixel - view().centre_px) / view().focal_px;
    const auto at = [&](float x_m) { return Eigen::Vector3f(x_m, y_m - bent.x() * x_m, -bent.y() * x_m); };
    const Eigen::Vector3f box = at(kBox_m);
    if (std::abs(box.y()) <= kHalfBox_m && std::abs(box.z()) <= kHalfBox_m) return box_light();
    return wall_light(at(kWall_m));
  }

  SyntheticMesh mesh_;
  std::size_t wall_vertices_ = 0;
};

}  // namespace lxd::test
