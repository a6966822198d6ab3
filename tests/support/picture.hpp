// SPDX-License-Identifier: Apache-2.0
// What a PNG file holds: enough to tell a picture with something in it from an empty one.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <set>

#include <cairo.h>

namespace lxd::test {

struct Picture {
  int width = 0, height = 0;
  std::size_t colours = 0;
};

inline Picture read_png(const std::filesystem::path& path) {
  const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface(
      cairo_image_surface_create_from_png(path.c_str()), cairo_surface_destroy);
  Picture picture{cairo_image_surface_get_width(surface.get()), cairo_image_surface_get_height(surface.get()), 0};
  const unsigned char* const data = cairo_image_surface_get_data(surface.get());
  std::set<std::uint32_t> colours;
  for (int y = 0; y < picture.height; ++y) {
    const unsigned char* const row =
        data + static_cast<std::ptrdiff_t>(y) * cairo_image_surface_get_stride(surface.get());
    for (int x = 0; x < picture.width; ++x) colours.insert(reinterpret_cast<const std::uint32_t*>(row)[x]);
  }
  picture.colours = colours.size();
  return picture;
}

}  // namespace lxd::test
