// SPDX-License-Identifier: Apache-2.0
#include "backend/colour/image_pyramid.hpp"

#include <algorithm>
#include <cmath>

#include "backend/colour/srgb.hpp"

namespace lxd {
namespace {

constexpr int kLevelsMax = 5;
constexpr int kSmallestSide_px = 8;

bool is_blind(const std::uint8_t* rgb) { return std::max({rgb[0], rgb[1], rgb[2]}) == kBlindLevel; }

// Of four neighbours, the lower two a row below.
void average(const std::uint8_t* upper, const std::uint8_t* lower, const Lights& light, std::uint8_t* out) {
  Eigen::Array3f sum = Eigen::Array3f::Zero();
  for (const std::uint8_t* const pixel : {upper, upper + 3, lower, lower + 3}) {
    if (is_blind(pixel)) return void(std::fill_n(out, 3, kBlindLevel));
    sum += light_of(pixel, light);
  }
  for (int c = 0; c < 3; ++c) out[c] = level_of(0.25F * sum[c]);
}

}  // namespace

ImagePyramid::ImagePyramid(const PinholeView& view, const std::vector<std::uint8_t>& rgb) {
  levels_.push_back({view.width, view.height, rgb.data()});
  halves_.reserve(kLevelsMax);
  while (static_cast<int>(levels_.size()) < kLevelsMax &&
         std::min(levels_.back().width, levels_.back().height) >= 2 * kSmallestSide_px)
    add_half();
}

void ImagePyramid::add_half() {
  const Level from = levels_.back();
  const Level to{from.width / 2, from.height / 2, nullptr};
  const Lights& light = lights();
  std::vector<std::uint8_t>& half = halves_.emplace_back(std::size_t{3} * to.width * to.height);
  for (int y = 0; y < to.height; ++y) {
    for (int x = 0; x < to.width; ++x) {
      const std::uint8_t* const upper = from.rgb + 3 * (std::size_t{2} * y * from.width + 2 * x);
      average(upper, upper + std::size_t{3} * from.width, light, half.data() + 3 * (std::size_t{1} * y * to.width + x));
    }
  }
  levels_.push_back({to.width, to.height, half.data()});
}

// Between four pixels of the level whose pixels are at most half as wide.
std::optional<Eigen::Array3f> ImagePyramid::light(const Eigen::Vector2f& pixel, float width_px) const {
  const int wanted = std::max(1, std::ilogb(std::max(width_px, 1.0F))) - 1;
  const int index = std::min(wanted, static_cast<int>(levels_.size()) - 1);
  const Level& level = levels_[static_cast<std::size_t>(index)];
  const Eigen::Vector2f at = std::ldexp(1.0F, -index) * (pixel.array() + 0.5F) - 0.5F;
  const Eigen::Vector2f floor = at.array().floor();
  if (!(floor.x() >= 0 && floor.y() >= 0 && floor.x() + 1 < static_cast<float>(level.width) &&
        floor.y() + 1 < static_cast<float>(level.height)))
    return std::nullopt;
  const Eigen::Vector2f part = at - floor;
  const std::uint8_t* const upper =
      level.rgb + 3 * (static_cast<std::size_t>(floor.y()) * level.width + static_cast<std::size_t>(floor.x()));
  const std::uint8_t* const lower = upper + std::size_t{3} * level.width;
  for (const std::uint8_t* const tap : {upper, upper + 3, lower, lower + 3})
    if (is_blind(tap)) return std::nullopt;
  return light_between(upper, lower, part, lights());
}

}  // namespace lxd
