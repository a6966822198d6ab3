// SPDX-License-Identifier: Apache-2.0
// sensor_msgs/Image and sensor_msgs/CompressedImage.
#pragma once

#include <string_view>

#include "drivers/ros1/header.hpp"

namespace lxd {

struct Ros1Picture {
  Ros1Header header;
  std::string_view encoding;  // as the message says it, also of one that is refused; valid as long as the message
  std::uint32_t width = 0, height = 0;
  std::uint32_t channels = 1;   // 1: grey; 3: colours
  bool blue_first = false;      // of colours
  std::uint32_t row_bytes = 0;  // from a row's begin to the next one's
  Ros1Reader::Bytes pixels;     // height rows at least

  // Precondition: y < height. channels * width bytes.
  [[nodiscard]] Ros1Reader::Bytes row(std::uint32_t y) const {
    return pixels.subspan(std::size_t{y} * row_bytes, std::size_t{width} * channels);
  }
};

// mono8, 8UC1, bgr8, rgb8; others are `unknown_encoding`.
Ros1Fault read_ros1_picture(Ros1Reader::Bytes message, Ros1Picture& out);

enum class Ros1Compression : std::uint8_t { jpeg, png };

struct Ros1CompressedPicture {
  Ros1Header header;
  Ros1Compression compression = Ros1Compression::jpeg;  // as the data's first bytes say
  Ros1Reader::Bytes data;                               // an image file
};
Ros1Fault read_ros1_compressed_picture(Ros1Reader::Bytes message, Ros1CompressedPicture& out);

}  // namespace lxd
