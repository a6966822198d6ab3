// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/camera/sights.hpp"

#include <cmath>

namespace lxd::sim {
namespace {

constexpr float kCrease = 0.95F;    // cosine between normals that meet in an edge
constexpr float kOffPlane = 0.01F;  // of the range: the other point lies on another surface

}  // namespace

bool differ(const Sights& a, std::size_t i, const Sights& b, std::size_t k) {
  const Hit &one = a.hits[i], &other = b.hits[k];
  if (!one.found() || !other.found()) return one.found() != other.found();
  if (one.material != other.material || one.mover != other.mover || one.normal.dot(other.normal) < kCrease) return true;
  const Eigen::Vector3f apart = other.range_m * b.rays[k].direction - one.range_m * a.rays[i].direction;
  return std::abs(apart.dot(one.normal)) > kOffPlane * one.range_m;
}

}  // namespace lxd::sim
