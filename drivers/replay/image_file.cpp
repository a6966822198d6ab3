// SPDX-License-Identifier: Apache-2.0
#include "drivers/replay/image_file.hpp"

#include <algorithm>
#include <csetjmp>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <span>
#include <string>

#include <jpeglib.h>
#include <png.h>

#include "drivers/camera/pixel_format.hpp"

namespace lxd {
namespace {

using ByteVector = std::vector<std::uint8_t>;

constexpr std::uint64_t kPixelsMax = std::uint64_t{1} << 26;
constexpr std::uint8_t kJpegBegin[] = {0xFF, 0xD8, 0xFF};  // ITU-T T.81, B.1.1.3: start of image, and a marker

bool is_jpeg(const ByteVector& file) {
  return file.size() > std::size(kJpegBegin) && std::equal(std::begin(kJpegBegin), std::end(kJpegBegin), file.begin());
}

// Grey, or blue, green, red.
struct Target {
  std::uint32_t channels;
  std::uint32_t& width;
  std::uint32_t& height;
  ByteVector& data;

  [[nodiscard]] bool coloured() const { return channels > 1; }
};

bool make_room(std::uint64_t width, std::uint64_t height, const Target& out) {
  if (width == 0 || height == 0 || width * height > kPixelsMax) return false;
  out.width = static_cast<std::uint32_t>(width);
  out.height = static_cast<std::uint32_t>(height);
  out.data.resize(std::size_t{out.channels} * out.width * out.height);
  return true;
}

// libpng's state of one image; freed however reading ends.
struct PngImage {
  png_image image{};
  PngImage() { image.version = PNG_IMAGE_VERSION; }
  PngImage(const PngImage&) = delete;
  PngImage& operator=(const PngImage&) = delete;
  ~PngImage() { png_image_free(&image); }
};

bool read_png(const ByteVector& file, const Target& out) {
  PngImage png;
  if (png_image_begin_read_from_memory(&png.image, file.data(), file.size()) == 0) return false;
  if (!make_room(png.image.width, png.image.height, out)) return false;
  png.image.format = out.coloured() ? PNG_FORMAT_BGR : PNG_FORMAT_GRAY;
  png_color black{};  // behind what is transparent
  return png_image_finish_read(&png.image, &black, out.data.data(), 0, nullptr) != 0;
}

// libjpeg reports errors by a function that must not return; this one jumps back to where reading began.
struct JpegErrors {
  jpeg_error_mgr manager{};  // the first member: libjpeg knows it by this address
  std::jmp_buf back{};
};

[[noreturn]] void give_up(j_common_ptr jpeg) { std::longjmp(reinterpret_cast<JpegErrors*>(jpeg->err)->back, 1); }
void say_nothing(j_common_ptr) {}

// Nothing with a destructor may live where the jump passes.
bool decode_jpeg(jpeg_decompress_struct& jpeg, JpegErrors& errors, const ByteVector& file, const Target& out) {
  if (setjmp(errors.back) != 0) return false;
  jpeg_mem_src(&jpeg, file.data(), file.size());
  jpeg_read_header(&jpeg, TRUE);
  if (!make_room(jpeg.image_width, jpeg.image_height, out)) return false;
  jpeg.out_color_space = out.coloured() ? JCS_EXT_BGR : JCS_GRAYSCALE;
  jpeg_start_decompress(&jpeg);
  while (jpeg.output_scanline < jpeg.output_height) {
    JSAMPROW row = out.data.data() + std::size_t{jpeg.output_scanline} * out.width * out.channels;
    jpeg_read_scanlines(&jpeg, &row, 1);
  }
  jpeg_finish_decompress(&jpeg);
  return errors.manager.num_warnings == 0;
}

bool read_jpeg(const ByteVector& file, const Target& out) {
  jpeg_decompress_struct jpeg{};
  JpegErrors errors;
  jpeg.err = jpeg_std_error(&errors.manager);
  errors.manager.error_exit = give_up;
  errors.manager.output_message = say_nothing;
  jpeg_create_decompress(&jpeg);
  const bool sound = decode_jpeg(jpeg, errors, file, out);
  jpeg_destroy_decompress(&jpeg);
  return sound;
}

// Netpbm's raw PGM (P5) and PPM (P6), as the recorder writes them: no comments, 255 the brightest.
bool is_netpbm(const ByteVector& file) {
  return file.size() > 2 && file[0] == 'P' && (file[1] == '5' || file[1] == '6') && file[2] == '\n';
}

bool read_netpbm(const ByteVector& file, const Target& out) {
  constexpr std::size_t kHeadMax = 64;
  const std::string head(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(std::min(file.size(), kHeadMax)));
  unsigned width = 0, height = 0, brightest = 0;
  int begin = 0;
  if (std::sscanf(head.c_str(), "P%*1c %u %u %u%n", &width, &height, &brightest, &begin) != 3) return false;
  if (brightest != 255 || !make_room(width, height, out)) return false;
  const bool grey = file[1] == '5';
  const FrameLayout layout{grey ? PixelFormat::grey : PixelFormat::rgb, width, height, 0};
  auto converter = PixelConverter::create(layout);
  // A single white space ends the head.
  const auto pixels = std::span(file).subspan(std::min(file.size(), static_cast<std::size_t>(begin) + 1));
  if (!converter) return false;
  return out.coloured() ? converter->to_bgr(pixels, out.data) : converter->to_grey(pixels, out.data);
}

bool read_whole(const std::filesystem::path& path, const Target& out) {
  std::ifstream stream(path, std::ios::binary);
  const ByteVector file{std::istreambuf_iterator<char>(stream), {}};
  if (is_netpbm(file)) return read_netpbm(file, out);
  return is_jpeg(file) ? read_jpeg(file, out) : read_png(file, out);
}

}  // namespace

bool read_image(const std::filesystem::path& path, GreyPixels& out) {
  return read_whole(path, {1, out.width, out.height, out.data});
}

bool read_image(const std::filesystem::path& path, ColourPixels& out) {
  return read_whole(path, {3, out.width, out.height, out.data});
}

}  // namespace lxd
