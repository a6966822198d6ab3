// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/camera/shading.hpp"

#include <algorithm>

namespace lxd::sim {
namespace {

// Not along a world's axes, so that walls that meet at right angles differ in brightness.
const Eigen::Vector3f kToSun = Eigen::Vector3f(0.48F, 0.31F, 0.82F).normalized();
constexpr float kSun = 0.45F;
constexpr float kFromAbove = 0.55F, kFromBelow = 0.25F;
// Patterns are stronger in visible light than at the LiDAR's wavelength, for which the albedos are.
constexpr float kVisibleContrast = 1.8F;
constexpr float kDarkest = 0.02F;
constexpr float kGlassReflects = 0.35F, kGlassShows = 0.06F;

Eigen::Array3f sky(const Eigen::Vector3f& direction) {
  const Eigen::Array3f horizon(0.85F, 0.88F, 0.92F), zenith(0.30F, 0.45F, 0.75F), ground(0.20F, 0.19F, 0.17F);
  const float height = direction.z();
  if (height < 0) return ground;
  return horizon + std::min(1.0F, 2 * height) * (zenith - horizon);
}

float light(const Eigen::Vector3f& normal) {
  const float above = (1 + normal.z()) / 2;
  return kFromBelow + above * (kFromAbove - kFromBelow) + kSun * std::max(0.0F, normal.dot(kToSun));
}

}  // namespace

Eigen::Array3f radiance(const World& world, const Hit& hit, const Eigen::Vector3f& direction) {
  if (!hit.found()) return sky(direction);
  const Material& material = world.materials[hit.material];
  const float albedo = std::max(kDarkest, material.albedo + kVisibleContrast * (hit.albedo - material.albedo));
  const Eigen::Array3f surface = albedo * light(hit.normal) * Eigen::Array3f(material.colour.data());
  if (!material.glass) return surface;
  const Eigen::Vector3f reflected = direction - 2 * direction.dot(hit.normal) * hit.normal;
  return kGlassShows * surface + kGlassReflects * sky(reflected);
}

}  // namespace lxd::sim
