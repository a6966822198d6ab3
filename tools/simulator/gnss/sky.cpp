// SPDX-License-Identifier: Apache-2.0
// See sky.hpp.
#include "tools/simulator/gnss/sky.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lxd::sim {
namespace {

constexpr std::size_t kDirections = 96;
constexpr float kFar_m = 500;

}  // namespace

// A spiral by the golden angle, even in the sine of the elevation: even in solid angle.
Sky::Sky(double mask_rad) {
  const double golden_rad = std::numbers::pi * (3 - std::sqrt(5.0));
  const double lowest = std::sin(mask_rad);
  for (std::size_t i = 0; i < kDirections; ++i) {
    const double up = lowest + (1 - lowest) * (static_cast<double>(i) + 0.5) / kDirections;
    const double azimuth_rad = golden_rad * static_cast<double>(i), level = std::sqrt(1 - up * up);
    directions_.emplace_back(
        Eigen::Vector3d(level * std::cos(azimuth_rad), level * std::sin(azimuth_rad), up).cast<float>());
  }
}

double Sky::blocked_part(const Scene& scene, const Eigen::Vector3d& antenna_m, double t_s) const {
  std::vector<Ray> rays;
  for (const Eigen::Vector3f& direction : directions_)
    rays.push_back({antenna_m.cast<float>(), direction, static_cast<float>(t_s), kFar_m});
  std::vector<Hit> hits(rays.size());
  scene.cast(rays, hits);
  const auto hides = [&](const Hit& hit) { return hit.found() && !scene.world().materials[hit.material].glass; };
  return static_cast<double>(std::count_if(hits.begin(), hits.end(), hides)) / static_cast<double>(hits.size());
}

}  // namespace lxd::sim
