// SPDX-License-Identifier: Apache-2.0
// Images before a camera's sensor: radiance with range. Rows follow each other without gaps.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lxd::sim {

struct RadianceImage {
  int width = 0, height = 0;
  int channels = 1;             // 1: luminance; 3: linear RGB, interleaved
  std::vector<float> radiance;  // width * height * channels; white in full light is 1
  std::vector<float> range_m;   // width * height; infinite where nothing was hit

  void resize(int columns, int rows, int colours) {
    width = columns;
    height = rows;
    channels = colours;
    const std::size_t pixels = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
    radiance.resize(pixels * static_cast<std::size_t>(colours));
    range_m.resize(pixels);
  }
  [[nodiscard]] std::size_t index(int u, int v) const {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u);
  }
};

}  // namespace lxd::sim
