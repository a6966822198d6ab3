// SPDX-License-Identifier: Apache-2.0
// One JPEG image into pixels, by libjpeg-turbo. The image must be of the size that the camera was set to and of the
// baseline sort, so that neither time nor memory is the sender's choice. Not for the real-time path: the library
// allocates.
#pragma once

#include <cstdint>
#include <span>

namespace lxd {

enum class JpegResult : std::uint8_t {
  kSound,
  kDamaged,   // no JPEG, cut off, wrong codes, or of a sort that no camera sends
  kOtherSize  // sound as far as its header goes
};

// channels: 1 grey, 3 blue-green-red. What is written of a damaged image has no meaning. Images without Huffman tables
// (as USB cameras send) get the standard's. Precondition: pixels.size() == width * height * channels.
JpegResult decode_jpeg(std::span<const std::uint8_t> jpeg, std::uint32_t width, std::uint32_t height,
                       std::uint32_t channels, std::span<std::uint8_t> pixels);

}  // namespace lxd
