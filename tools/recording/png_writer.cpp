// SPDX-License-Identifier: Apache-2.0
#include "tools/recording/png_writer.hpp"

#include <span>
#include <vector>

#include <fmt/format.h>
#include <png.h>

#include "tools/recording/whole_file.hpp"

namespace lxd {
namespace {

Result<std::vector<char>> packed(const PixelImage& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.width);
  header.height = static_cast<png_uint_32>(image.height);
  header.format = image.channels == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_RGB;
  header.flags = PNG_IMAGE_FLAG_FAST;
  std::vector<char> bytes(PNG_IMAGE_PNG_SIZE_MAX(header));
  png_alloc_size_t size = bytes.size();
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, image.data.data(), 0, nullptr) == 0)
    return Error{header.message};
  bytes.resize(size);
  return bytes;
}

}  // namespace

Status write_png(const std::filesystem::path& path, const PixelImage& image) {
  const auto bytes = packed(image);
  if (!bytes) return Error{fmt::format("{}: {}", path.string(), bytes.error().message)};
  return write_whole_file(path, std::as_bytes(std::span(*bytes)));
}

}  // namespace lxd
