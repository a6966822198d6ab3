// SPDX-License-Identifier: Apache-2.0
// A small z-buffered rasteriser for shaded triangles: no graphics card, no window, the same picture everywhere.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace lxd {

using Colour = Eigen::Vector3f;  // red, green, blue, 0..1

class Raster {
 public:
  Raster(int width_px, int height_px);

  // Corner: pixels right and down, and metres towards the eye. The nearest surface stays.
  using Corner = Eigen::Vector3d;
  void triangle(const std::array<Corner, 3>& corners, const std::array<Colour, 3>& colours);
  // One pixel wide; for surfaces seen edge-on, which cover no pixel's middle.
  void line(const Corner& a, const Corner& b, const Colour& colour);

  // Darkens pixels whose neighbourhood is nearer to the eye (eye-dome lighting: Boucheny, 2009): edges and steps show.
  void shade_by_depth(double strength_per_m);

  [[nodiscard]] int width() const { return width_px_; }
  [[nodiscard]] int height() const { return height_px_; }
  [[nodiscard]] bool covered(int x, int y) const { return depth_[index(x, y)] > kNothing; }
  [[nodiscard]] Colour colour(int x, int y) const { return unpacked(colour_[index(x, y)]); }

 private:
  using Pixel = std::array<std::uint8_t, 3>;  // what a picture holds: a supersampled raster is millions of them
  static constexpr float kNothing = -1e30F;
  static Pixel packed(const Colour& colour);
  static Colour unpacked(const Pixel& pixel) { return Colour(pixel[0], pixel[1], pixel[2]) / 255.0F; }
  [[nodiscard]] std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * width_px_ + x; }
  void put(int x, int y, double depth_m, const Colour& colour);
  [[nodiscard]] float depth_step(int x, int y) const;

  int width_px_, height_px_;
  std::vector<float> depth_;
  std::vector<Pixel> colour_;
};

}  // namespace lxd
