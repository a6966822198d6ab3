// SPDX-License-Identifier: Apache-2.0
// Rays into a world (Embree). Safe to call from many threads once made.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <span>

#include <Eigen/Core>

#include "tools/simulator/world/world.hpp"

namespace lxd::sim {

struct Ray {
  Eigen::Vector3f origin_m;
  Eigen::Vector3f direction;  // unit
  float t_s = 0;              // since the recording's start: where the movers are
  float range_max_m = 1000;
  bool movers = true;          // false: as if nothing moved in the world
  float spread_rad = 1.5e-3F;  // the beam's or pixel's width: the texture is averaged over its footprint
};

struct Hit {
  static constexpr float kNone = std::numeric_limits<float>::infinity();
  float range_m = kNone;
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  // unit, facing the ray's origin
  std::uint32_t face = 0;                            // of the world; undefined for a mover
  std::uint16_t material = 0;
  bool mover = false;
  float albedo = 0;  // textured, at the point that was hit

  [[nodiscard]] bool found() const { return range_m != kNone; }
};

class Scene {
 public:
  // Keeps a reference: the world must outlive the scene.
  explicit Scene(const World& world);
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  // hits as rays. A glass face is hit like any other: the material tells, and the sensor decides.
  void cast(std::span<const Ray> rays, std::span<Hit> hits) const;
  [[nodiscard]] Hit cast(const Ray& ray) const;

  [[nodiscard]] const World& world() const { return world_; }

 private:
  struct Impl;
  const World& world_;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lxd::sim
