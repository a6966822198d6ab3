// SPDX-License-Identifier: Apache-2.0
// JPEG images for tests: a ramp of colours, as a camera would send it.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

#include <jpeglib.h>

namespace lxd::test {

struct JpegKind {
  bool colour = true, progressive = false;
};

// Red grows to the right, green downwards, blue is 64; without colour the pixel is the mean of x and y.
inline std::vector<std::uint8_t> made_jpeg(std::uint32_t width, std::uint32_t height, const JpegKind& kind = {}) {
  const std::uint32_t channels = kind.colour ? 3 : 1;
  jpeg_compress_struct info{};
  jpeg_error_mgr errors{};
  info.err = jpeg_std_error(&errors);
  jpeg_create_compress(&info);
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  jpeg_mem_dest(&info, &bytes, &size);
  info.image_width = width;
  info.image_height = height;
  info.input_components = static_cast<int>(channels);
  info.in_color_space = kind.colour ? JCS_RGB : JCS_GRAYSCALE;
  jpeg_set_defaults(&info);
  jpeg_set_quality(&info, 95, TRUE);
  if (kind.progressive) jpeg_simple_progression(&info);
  jpeg_start_compress(&info, TRUE);
  std::vector<std::uint8_t> line(std::size_t{width} * channels);
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const auto red = static_cast<std::uint8_t>(4 * x), green = static_cast<std::uint8_t>(4 * y);
      std::uint8_t* const pixel = &line[std::size_t{x} * channels];
      pixel[0] = kind.colour ? red : static_cast<std::uint8_t>((red + green) / 2);
      if (!kind.colour) continue;
      pixel[1] = green;
      pixel[2] = 64;
    }
    JSAMPROW row = line.data();
    jpeg_write_scanlines(&info, &row, 1);
  }
  jpeg_finish_compress(&info);
  jpeg_destroy_compress(&info);
  std::vector<std::uint8_t> jpeg(bytes, bytes + size);
  std::free(bytes);
  return jpeg;
}

}  // namespace lxd::test
