// SPDX-License-Identifier: Apache-2.0
// A key image at half sizes, so that what a vertex stands for is averaged as light and not picked out of it.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "backend/colour/key_image.hpp"

namespace lxd {

class ImagePyramid {
 public:
  // rgb: of the view; it must outlive the pyramid.
  ImagePyramid(const PinholeView& view, const std::vector<std::uint8_t>& rgb);

  // The light around a pixel, averaged over about `width_px`. None: off the image, or part of it is blind.
  [[nodiscard]] std::optional<Eigen::Array3f> light(const Eigen::Vector2f& pixel, float width_px) const;

 private:
  struct Level {
    int width, height;
    const std::uint8_t* rgb;
  };
  void add_half();

  std::vector<Level> levels_;
  std::vector<std::vector<std::uint8_t>> halves_;
};

}  // namespace lxd
