// SPDX-License-Identifier: Apache-2.0
// Cairo, as far as the overview and the plots need it: an image, lines, areas, marks and text.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>

#include <Eigen/Core>
#include <cairo.h>

#include "backend/overview_palette.hpp"
#include "rt/result.hpp"

namespace lxd {

class Canvas {
 public:
  Canvas(int width_px, int height_px);

  // Each pixel is the mean of supersampling^2 pixels of the raster; what is not covered shows the background.
  void image(const Raster& raster, const Eigen::Vector2i& corner_px, int supersampling);
  void line(const Eigen::Vector2d& a, const Eigen::Vector2d& b, double width_px, const Colour& colour,
            double opacity = 1);
  void polyline(std::span<const Eigen::Vector2d> points, double width_px, const Colour& colour, double opacity = 1);
  void area(std::span<const Eigen::Vector2d> outline, const Colour& colour, double opacity = 1);
  void disc(const Eigen::Vector2d& centre, double radius_px, const Colour& colour);
  enum class Anchor { left, middle, right };
  void text(const Eigen::Vector2d& baseline, const std::string& text, double size_px, const Colour& colour,
            Anchor anchor, bool bold = false);
  [[nodiscard]] double text_width_px(const std::string& text, double size_px, bool bold = false);
  void clip(const Eigen::Vector2d& corner, const Eigen::Vector2d& size);
  void unclip();

  Status write_png(const std::filesystem::path& path);

 private:
  struct DestroySurface {
    void operator()(cairo_surface_t* s) const { cairo_surface_destroy(s); }
  };
  struct DestroyContext {
    void operator()(cairo_t* c) const { cairo_destroy(c); }
  };
  void set(const Colour& colour, double opacity = 1);
  void select_font(double size_px, bool bold);
  void trace(std::span<const Eigen::Vector2d> points);
  std::unique_ptr<cairo_surface_t, DestroySurface> surface_;
  std::unique_ptr<cairo_t, DestroyContext> cairo_;
};

}  // namespace lxd
