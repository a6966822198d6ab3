// SPDX-License-Identifier: Apache-2.0
// 8-bit PNG, grey or RGB, packed for speed.
#pragma once

#include <filesystem>

#include "rt/result.hpp"
#include "tools/recording/pixel_image.hpp"

namespace lxd {

// Errors name the file: it cannot be made, or the disk is full.
Status write_png(const std::filesystem::path& path, const PixelImage& image);

}  // namespace lxd
