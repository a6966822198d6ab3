// SPDX-License-Identifier: Apache-2.0
// See jpeg_decoder.hpp.
#include "drivers/camera/jpeg_decoder.hpp"

#include <csetjmp>
#include <cstddef>
#include <cstdio>  // jpeglib.h needs it and does not say so

#include <jerror.h>
#include <jpeglib.h>

namespace lxd {
namespace {

constexpr std::uint32_t kBgrChannels = 3;

// The library reports by calls back: errors by one that must not return.
struct Report {
  jpeg_error_mgr manager{};  // first: the library knows no more than its address
  std::jmp_buf back{};
  bool damaged = false;
};

Report& report_of(j_common_ptr info) { return *reinterpret_cast<Report*>(info->err); }

void on_error(j_common_ptr info) { std::longjmp(report_of(info).back, 1); }

// Cameras leave stray bytes between markers; all other warnings are of data that are not what was sent.
void on_message(j_common_ptr info, int level) {
  if (level < 0 && info->err->msg_code != JWRN_EXTRANEOUS_DATA) report_of(info).damaged = true;
}

void be_silent(j_common_ptr) {}

struct Wanted {
  std::uint32_t width, height, channels;
  std::uint8_t* pixels;
};

// Left by longjmp from within the library: holds nothing that would have to be destroyed.
JpegResult decode(jpeg_decompress_struct& info, Report& report, std::span<const std::uint8_t> jpeg,
                  const Wanted& wanted) {
  if (setjmp(report.back) != 0) return JpegResult::kDamaged;
  jpeg_mem_src(&info, jpeg.data(), jpeg.size());
  jpeg_read_header(&info, TRUE);
  if (info.image_width != wanted.width || info.image_height != wanted.height) return JpegResult::kOtherSize;
  if (info.progressive_mode != FALSE || info.arith_code != FALSE) return JpegResult::kDamaged;
  info.out_color_space = wanted.channels == kBgrChannels ? JCS_EXT_BGR : JCS_GRAYSCALE;
  jpeg_start_decompress(&info);
  const std::size_t row_bytes = std::size_t{wanted.width} * wanted.channels;
  while (info.output_scanline < wanted.height) {
    JSAMPROW row = wanted.pixels + info.output_scanline * row_bytes;
    jpeg_read_scanlines(&info, &row, 1);
  }
  jpeg_finish_decompress(&info);
  return report.damaged ? JpegResult::kDamaged : JpegResult::kSound;
}

}  // namespace

JpegResult decode_jpeg(std::span<const std::uint8_t> jpeg, std::uint32_t width, std::uint32_t height,
                       std::uint32_t channels, std::span<std::uint8_t> pixels) {
  if (jpeg.empty()) return JpegResult::kDamaged;
  Report report;
  jpeg_decompress_struct info{};
  info.err = jpeg_std_error(&report.manager);
  report.manager.error_exit = &on_error;
  report.manager.emit_message = &on_message;
  report.manager.output_message = &be_silent;
  jpeg_create_decompress(&info);
  const JpegResult result = decode(info, report, jpeg, {width, height, channels, pixels.data()});
  jpeg_destroy_decompress(&info);
  return result;
}

}  // namespace lxd
