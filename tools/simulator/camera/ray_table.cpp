// SPDX-License-Identifier: Apache-2.0
#include "tools/simulator/camera/ray_table.hpp"

#include <algorithm>

namespace lxd::sim {

RayTable::RayTable(const CameraConfig& config)
    : width_(static_cast<int>(config.resolution[0])), height_(static_cast<int>(config.resolution[1])) {
  const CameraModel model(intrinsics_of(config));
  rays_.reserve(index(0, height_ + 1));
  for (int v = 0; v <= height_; ++v) {
    for (int u = 0; u <= width_; ++u) {
      const auto ray = model.unproject({static_cast<double>(u), static_cast<double>(v)});
      rays_.push_back(ray.value_or(Eigen::Vector3d::UnitZ()).cast<float>());
    }
  }
  for (int v = 0; v < height_; ++v) {
    for (int u = 0; u < width_; ++u) spread_rad_ = std::max(spread_rad_, (at(u + 1, v) - at(u, v)).norm());
  }
}

Eigen::Vector3f RayTable::beside(int u, int v, float du, float dv) const {
  const Eigen::Vector3f& here = at(u, v);
  return (here + du * (at(u + 1, v) - here) + dv * (at(u, v + 1) - here)).normalized();
}

}  // namespace lxd::sim
