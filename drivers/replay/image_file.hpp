// SPDX-License-Identifier: Apache-2.0
// An image file as grey or coloured pixels of eight bits, whatever it holds; colours as grey by their luminance. PNG by
// libpng, JPEG by libjpeg, PGM and PPM as the recorder writes them: OpenCV's own codecs would load 100 libraries more.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

namespace lxd {

// Rows follow each other without gaps. The memory is used again from image to image.
struct GreyPixels {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> data;
};

// Blue, green, red; otherwise likewise.
struct ColourPixels {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> data;
};

// False: none of these by its content, truncated, damaged as far as the format can tell, or more than 2^26
// pixels.
bool read_image(const std::filesystem::path& path, GreyPixels& out);
bool read_image(const std::filesystem::path& path, ColourPixels& out);

}  // namespace lxd
