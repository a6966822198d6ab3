// SPDX-License-Identifier: Apache-2.0
// See pixel_format.hpp.
#include "drivers/camera/pixel_format.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "drivers/camera/jpeg_decoder.hpp"
#include "drivers/refuse.hpp"

namespace lxd {
namespace {

struct Code {
  std::uint32_t fourcc_code;
  PixelFormat format;
};
constexpr std::array kCodes{Code{fourcc("GREY"), PixelFormat::grey}, Code{fourcc("YUYV"), PixelFormat::yuyv},
                            Code{fourcc("RGB3"), PixelFormat::rgb}, Code{fourcc("MJPG"), PixelFormat::mjpeg},
                            Code{fourcc("JPEG"), PixelFormat::mjpeg}};

constexpr std::uint32_t kBgr = 3;

std::uint32_t bytes_per_pixel(PixelFormat format) {
  switch (format) {
    case PixelFormat::yuyv:
      return 2;
    case PixelFormat::rgb:
      return 3;
    default:
      return 1;
  }
}

std::uint8_t clamped(int value) { return static_cast<std::uint8_t>(std::clamp(value, 0, 255)); }

// Fixed point with 8 bits: BT.601's weights of the three colours.
std::uint8_t luma(const std::uint8_t* rgb) {
  return static_cast<std::uint8_t>((77U * rgb[0] + 150U * rgb[1] + 29U * rgb[2] + 128U) >> 8U);
}

// BT.601, limited range (Y 16 .. 235, colours 16 .. 240), fixed point with 8 bits.
void put_bgr(int y, int u, int v, std::uint8_t* bgr) {
  const int light = 298 * (y - 16) + 128, blue = u - 128, red = v - 128;
  bgr[0] = clamped((light + 516 * blue) >> 8);
  bgr[1] = clamped((light - 100 * blue - 208 * red) >> 8);
  bgr[2] = clamped((light + 409 * red) >> 8);
}

void grey_line(PixelFormat format, const std::uint8_t* line, std::uint32_t width, std::uint8_t* out) {
  const std::uint32_t step = bytes_per_pixel(format);
  if (format == PixelFormat::rgb) {
    for (std::uint32_t x = 0; x < width; ++x) out[x] = luma(line + x * step);
  } else {
    for (std::uint32_t x = 0; x < width; ++x) out[x] = line[x * step];  // of YUYV every second byte is Y
  }
}

void bgr_line(PixelFormat format, const std::uint8_t* line, std::uint32_t width, std::uint8_t* out) {
  for (std::uint32_t x = 0; x < width; ++x, out += kBgr) {
    if (format == PixelFormat::yuyv) {
      const std::uint8_t* const pair = line + 4 * (x / 2);
      put_bgr(line[2 * x], pair[1], pair[3], out);
    } else if (format == PixelFormat::rgb) {
      std::reverse_copy(line + kBgr * x, line + kBgr * (x + 1), out);
    } else {
      std::fill_n(out, kBgr, line[x]);
    }
  }
}

}  // namespace

std::optional<std::uint32_t> fourcc_of_format(std::string_view name) {
  const auto found = std::ranges::find(kPixelFormatNames, name);
  if (found == kPixelFormatNames.end()) return std::nullopt;
  const auto format = static_cast<PixelFormat>(found - kPixelFormatNames.begin());
  return std::ranges::find(kCodes, format, &Code::format)->fourcc_code;
}

std::optional<PixelFormat> find_pixel_format(std::uint32_t fourcc_code) {
  const auto* const found = std::ranges::find(kCodes, fourcc_code, &Code::fourcc_code);
  return found == kCodes.end() ? std::nullopt : std::optional(found->format);
}

Result<PixelConverter> PixelConverter::create(const FrameLayout& layout) {
  const auto side = [](std::uint32_t pixels) { return pixels >= 1 && pixels <= kSideMax; };
  if (!side(layout.width) || !side(layout.height)) {
    return Error{
        fmt::format("frame: found {} x {} pixels, wanted 1 to {} each", layout.width, layout.height, kSideMax)};
  }
  if (layout.format == PixelFormat::yuyv && layout.width % 2 != 0)
    return Error{
        fmt::format("frame: found a width of {} pixels, wanted an even one: YUYV comes in pairs", layout.width)};
  FrameLayout whole = layout;
  const std::uint32_t least = layout.width * bytes_per_pixel(layout.format);
  if (layout.bytes_per_line == 0 || layout.format == PixelFormat::mjpeg) whole.bytes_per_line = least;
  if (whole.bytes_per_line >= least) return PixelConverter(whole);
  return Error{fmt::format("frame: found {} bytes a line, wanted at least {} for {} pixels", layout.bytes_per_line,
                           least, layout.width)};
}

bool PixelConverter::to_grey(std::span<const std::uint8_t> frame, std::span<std::uint8_t> image) {
  return convert(frame, image, 1);
}

bool PixelConverter::to_bgr(std::span<const std::uint8_t> frame, std::span<std::uint8_t> image) {
  return convert(frame, image, kBgr);
}

bool PixelConverter::convert(std::span<const std::uint8_t> frame, std::span<std::uint8_t> image,
                             std::uint32_t channels) {
  if (image.size() != grey_bytes() * channels) return refuse(counts_.no_room);
  if (layout_.format == PixelFormat::mjpeg) return from_jpeg(frame, image, channels);
  // The last line may come without its gap.
  const std::size_t last_line = std::size_t{layout_.width} * bytes_per_pixel(layout_.format);
  if (frame.size() < std::size_t{layout_.bytes_per_line} * (layout_.height - 1) + last_line)
    return refuse(counts_.bad_size);
  const std::size_t image_line = std::size_t{layout_.width} * channels;
  for (std::size_t y = 0; y < layout_.height; ++y) {
    const std::uint8_t* const line = frame.data() + y * layout_.bytes_per_line;
    std::uint8_t* const out = image.data() + y * image_line;
    channels == kBgr ? bgr_line(layout_.format, line, layout_.width, out)
                     : grey_line(layout_.format, line, layout_.width, out);
  }
  ++counts_.frames;
  return true;
}

bool PixelConverter::from_jpeg(std::span<const std::uint8_t> frame, std::span<std::uint8_t> image,
                               std::uint32_t channels) {
  switch (decode_jpeg(frame, layout_.width, layout_.height, channels, image)) {
    case JpegResult::kDamaged:
      return refuse(counts_.bad_jpeg);
    case JpegResult::kOtherSize:
      return refuse(counts_.other_size);
    case JpegResult::kSound:
      break;
  }
  ++counts_.frames;
  return true;
}

}  // namespace lxd
