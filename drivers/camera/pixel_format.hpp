// SPDX-License-Identifier: Apache-2.0
// A camera's frames, as V4L2 hands them over, into 8-bit grey or blue-green-red images. Every length is checked before
// a byte is read, every refusal is counted by cause. Source: linux/videodev2.h and the kernel's pixel format pages.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "rt/result.hpp"

namespace lxd {

enum class PixelFormat : std::uint8_t {
  grey,   // GREY: a byte a pixel
  yuyv,   // YUYV: two pixels in four bytes, Y U Y V; BT.601, limited range
  rgb,    // RGB3: red, green, blue
  mjpeg,  // MJPG, JPEG: an image of its own each
};
inline constexpr std::array<std::string_view, 4> kPixelFormatNames{"grey", "yuyv", "rgb", "mjpeg"};

// As V4L2 writes a format's four characters, the first lowest. None: not one of these.
constexpr std::uint32_t fourcc(const char (&name)[5]) {
  std::uint32_t code = 0;
  for (unsigned i = 0; i < 4; ++i) code |= static_cast<std::uint32_t>(static_cast<std::uint8_t>(name[i])) << 8U * i;
  return code;
}
std::optional<PixelFormat> find_pixel_format(std::uint32_t fourcc_code);
// Of kPixelFormatNames, as a camera is asked for it. None: not one of these.
std::optional<std::uint32_t> fourcc_of_format(std::string_view name);

// What VIDIOC_G_FMT says.
struct FrameLayout {
  PixelFormat format = PixelFormat::grey;
  std::uint32_t width = 0, height = 0;
  std::uint32_t bytes_per_line = 0;  // 0: without gaps; of mjpeg it has no meaning
};

struct PixelCounts {
  std::uint64_t frames = 0;      // converted
  std::uint64_t bad_size = 0;    // shorter than the layout's frames
  std::uint64_t bad_jpeg = 0;    // damaged, or of a sort that cameras do not send
  std::uint64_t other_size = 0;  // a JPEG of another width or height
  std::uint64_t no_room = 0;     // the image lent is not of the layout's size
};

class PixelConverter {
 public:
  static constexpr std::uint32_t kSideMax = 16'384;

  // Error: a layout that no frame can have.
  static Result<PixelConverter> create(const FrameLayout& layout);

  [[nodiscard]] std::size_t grey_bytes() const { return std::size_t{layout_.width} * layout_.height; }
  [[nodiscard]] std::size_t bgr_bytes() const { return 3 * grey_bytes(); }

  // The image has no gaps and must be of exactly grey_bytes() or bgr_bytes(). False: refused and counted; the image is
  // then without meaning. Allocate nothing, but for mjpeg.
  bool to_grey(std::span<const std::uint8_t> frame, std::span<std::uint8_t> image);
  bool to_bgr(std::span<const std::uint8_t> frame, std::span<std::uint8_t> image);

  [[nodiscard]] const PixelCounts& counts() const { return counts_; }
  [[nodiscard]] const FrameLayout& layout() const { return layout_; }

 private:
  explicit PixelConverter(const FrameLayout& layout) : layout_(layout) {}
  bool convert(std::span<const std::uint8_t> frame, std::span<std::uint8_t> image, std::uint32_t channels);
  bool from_jpeg(std::span<const std::uint8_t> frame, std::span<std::uint8_t> image, std::uint32_t channels);

  FrameLayout layout_;  // bytes_per_line is never 0
  PixelCounts counts_;
};

}  // namespace lxd
