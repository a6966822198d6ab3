// SPDX-License-Identifier: Apache-2.0
// A camera at an instant, its rays, and what they met.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "rt/pose.hpp"
#include "tools/simulator/world/scene.hpp"

namespace lxd::sim {

struct View {
  View(const Pose& T_world_camera, double at_s, float pixel_rad)
      : R_world_camera(T_world_camera.R.cast<float>()),
        p_world(T_world_camera.p.cast<float>()),
        t_s(static_cast<float>(at_s)),
        spread_rad(pixel_rad) {}

  [[nodiscard]] Ray ray(const Eigen::Vector3f& direction_camera) const {
    Ray ray;
    ray.origin_m = p_world;
    ray.direction = R_world_camera * direction_camera;
    ray.t_s = t_s;
    ray.spread_rad = spread_rad;
    return ray;
  }

  Eigen::Matrix3f R_world_camera;
  Eigen::Vector3f p_world;
  float t_s;
  float spread_rad;
};

struct Sights {
  std::vector<Ray> rays;
  std::vector<Hit> hits;  // as rays, once they are cast

  void cast(const Scene& scene) {
    hits.resize(rays.size());
    scene.cast(rays, hits);
  }
};

// Whether ray i of a and ray k of b, nearly side by side, meet different surfaces.
[[nodiscard]] bool differ(const Sights& a, std::size_t i, const Sights& b, std::size_t k);

}  // namespace lxd::sim
