// SPDX-License-Identifier: Apache-2.0
// Pixels of eight bits, grey or coloured. Rows follow each other without gaps.
#pragma once

#include <cstdint>
#include <vector>

namespace lxd {

struct PixelImage {
  int width = 0, height = 0;
  int channels = 1;                // 1: grey; 3: RGB, interleaved
  std::vector<std::uint8_t> data;  // width * height * channels
};

}  // namespace lxd
