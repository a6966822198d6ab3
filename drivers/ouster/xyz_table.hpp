// SPDX-License-Identifier: Apache-2.0
// Range image to points by a table: p = range * direction + offset for each pixel, so that the hot loop has no
// trigonometry. Derivation: README. Built once; then read only.
#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "drivers/ouster/metadata.hpp"

namespace lxd {

class OusterXyzTable {
 public:
  explicit OusterXyzTable(const OusterMetadata& metadata);

  // m, sensor frame. pixel = column * rows + row as in OusterFrame.
  [[nodiscard]] Eigen::Vector3f point(std::size_t pixel, std::uint32_t range_mm) const {
    return static_cast<float>(range_mm) * direction_[pixel] + offset_[pixel];
  }

 private:
  std::vector<Eigen::Vector3f> direction_;  // m per mm
  std::vector<Eigen::Vector3f> offset_;     // m
};

}  // namespace lxd
