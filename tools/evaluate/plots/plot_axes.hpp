// SPDX-License-Identifier: Apache-2.0
// One panel of a plot: its ground, grid, numbers, title and legend, and what is drawn into it.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "backend/overview_canvas.hpp"
#include "tools/evaluate/plots/plot_scale.hpp"

namespace lxd {

struct PanelPlace {
  Eigen::Vector2d corner_px, size_px;  // with title and numbers
};

struct PanelText {
  std::string title;
  std::string unit_x, unit_y;
  std::string remark;  // faint, beside the title
};

struct PanelScales {
  Interval x, y;
  ScaleKind kind_x = ScaleKind::linear, kind_y = ScaleKind::linear;
};

class PlotAxes {
 public:
  // Draws the empty panel. Keeps a reference to the canvas.
  PlotAxes(Canvas& canvas, const PanelPlace& place, const PanelText& text, const PanelScales& scales);

  // x grows; x and y are as long. Numbers that are not finite are gaps. A curve of more points than pixels is drawn by
  // the least and the greatest of each column of pixels, so that no spike is lost.
  void curve(std::span<const double> x, std::span<const double> y, const Colour& colour, double width_px = 1.6);
  void band(std::span<const double> x, std::span<const double> low, std::span<const double> high, const Colour& colour,
            double opacity);
  void dots(std::span<const double> x, std::span<const double> y, const Colour& colour, double radius_px);
  // From the scale's lower end up to y.
  void bar(const Interval& x, double y, const Colour& colour, double opacity);
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Colour& colour, double width_px = 1.2,
            double opacity = 0.8);
  void level(double y, const Colour& colour);  // across the panel

  // A name in the colour of its curve, right of those before it.
  void legend(const std::string& name, const Colour& colour);
  void say_nothing_known();  // in the middle, instead of curves

 private:
  void draw_grid(const PanelText& text);
  void draw_title(const PanelText& text);
  [[nodiscard]] Eigen::Vector2d at(double x, double y) const { return {x_.pixel(x), y_.pixel(y)}; }
  void clipped_line(const std::vector<Eigen::Vector2d>& points, double width_px, const Colour& colour);

  Canvas& canvas_;
  PanelPlace place_;
  Eigen::Vector2d low_px_, high_px_;  // of the ground: left and top, right and bottom
  PlotScale x_, y_;
  double legend_px_ = 0;  // how far the legend has come from the right
};

}  // namespace lxd
