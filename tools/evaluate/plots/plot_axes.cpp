// SPDX-License-Identifier: Apache-2.0
// Drawing of panels.
#include "tools/evaluate/plots/plot_axes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace lxd {
namespace {

using Eigen::Vector2d;

constexpr double kLeft_px = 66, kRight_px = 10, kTop_px = 34, kBottom_px = 26;  // around the ground
constexpr double kTitleText_px = 16, kTickText_px = 13;
constexpr double kTickRoom_x_px = 110, kTickRoom_y_px = 32;  // a number every so many pixels, about
constexpr double kGridOpacity = 0.16;

Vector2d ground_low(const PanelPlace& place) { return place.corner_px + Vector2d(kLeft_px, kTop_px); }
Vector2d ground_high(const PanelPlace& place) {
  return place.corner_px + place.size_px - Vector2d(kRight_px, kBottom_px);
}

std::array<Vector2d, 4> rectangle(const Vector2d& a, const Vector2d& b) {
  return {a, Vector2d(b.x(), a.y()), b, Vector2d(a.x(), b.y())};
}

// One column of pixels of a dense curve: what came first, the extremes, what came last.
void add_column(std::vector<Vector2d>& points, std::span<const Vector2d> column) {
  points.push_back(column.front());
  if (column.size() > 2) {
    const auto [low, high] = std::ranges::minmax_element(column, {}, [](const Vector2d& p) { return p.y(); });
    points.push_back(std::min(low, high) == low ? *low : *high);
    points.push_back(std::min(low, high) == low ? *high : *low);
  }
  points.push_back(column.back());
}

std::vector<Vector2d> thinned(const std::vector<Vector2d>& points) {
  std::vector<Vector2d> kept;
  for (std::size_t begin = 0, end = 0; begin < points.size(); begin = end) {
    while (end < points.size() && std::floor(points[end].x()) == std::floor(points[begin].x())) ++end;
    add_column(kept, std::span(points).subspan(begin, end - begin));
  }
  return kept;
}

}  // namespace

PlotAxes::PlotAxes(Canvas& canvas, const PanelPlace& place, const PanelText& text, const PanelScales& scales)
    : canvas_(canvas),
      place_(place),
      low_px_(ground_low(place)),
      high_px_(ground_high(place)),
      x_(scales.x, low_px_.x(), high_px_.x(), scales.kind_x),
      y_(scales.y, high_px_.y(), low_px_.y(), scales.kind_y) {
  canvas_.area(rectangle(low_px_, high_px_), kPlotGround);
  draw_grid(text);
  draw_title(text);
}

void PlotAxes::draw_grid(const PanelText& text) {
  const Vector2d size = high_px_ - low_px_;
  const auto ticks_x = x_.ticks(std::max(2, static_cast<int>(size.x() / kTickRoom_x_px)));
  for (const Tick& tick : ticks_x) {
    const double x = x_.pixel(tick.value);
    canvas_.line({x, low_px_.y()}, {x, high_px_.y()}, 1, kFaintInk, kGridOpacity);
    const bool last = &tick == &ticks_x.back();
    canvas_.text({x, high_px_.y() + 18}, last ? tick.text + " " + text.unit_x : tick.text, kTickText_px, kFaintInk,
                 Canvas::Anchor::middle);
  }
  for (const Tick& tick : y_.ticks(std::max(2, static_cast<int>(size.y() / kTickRoom_y_px)))) {
    const double y = y_.pixel(tick.value);
    canvas_.line({low_px_.x(), y}, {high_px_.x(), y}, 1, kFaintInk, tick.value == 0 ? 3 * kGridOpacity : kGridOpacity);
    canvas_.text({low_px_.x() - 8, y + 4.5}, tick.text, kTickText_px, kFaintInk, Canvas::Anchor::right);
  }
}

void PlotAxes::draw_title(const PanelText& text) {
  const Vector2d baseline(low_px_.x(), low_px_.y() - 11);
  canvas_.text(baseline, text.title, kTitleText_px, kInk, Canvas::Anchor::left, true);
  double right = baseline.x() + canvas_.text_width_px(text.title, kTitleText_px, true);
  if (!text.unit_y.empty()) {
    const std::string unit = "  " + text.unit_y;
    canvas_.text({right, baseline.y()}, unit, kTitleText_px, kFaintInk, Canvas::Anchor::left);
    right += canvas_.text_width_px(unit, kTitleText_px);
  }
  canvas_.text({right + 18, baseline.y()}, text.remark, kTickText_px, kFaintInk, Canvas::Anchor::left);
}

void PlotAxes::clipped_line(const std::vector<Vector2d>& points, double width_px, const Colour& colour) {
  if (points.empty()) return;
  canvas_.clip(low_px_, high_px_ - low_px_);
  canvas_.polyline(thinned(points), width_px, colour);
  canvas_.unclip();
}

void PlotAxes::curve(std::span<const double> x, std::span<const double> y, const Colour& colour, double width_px) {
  std::vector<Vector2d> points;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isfinite(x[i]) && std::isfinite(y[i])) {
      points.push_back(at(x[i], y[i]));
      continue;
    }
    clipped_line(points, width_px, colour);
    points.clear();
  }
  clipped_line(points, width_px, colour);
}

void PlotAxes::band(std::span<const double> x, std::span<const double> low, std::span<const double> high,
                    const Colour& colour, double opacity) {
  std::vector<Vector2d> upper, lower;
  const auto close = [&] {
    upper = thinned(upper);
    lower = thinned(lower);
    upper.insert(upper.end(), lower.rbegin(), lower.rend());
    canvas_.area(upper, colour, opacity);
    upper.clear();
    lower.clear();
  };
  canvas_.clip(low_px_, high_px_ - low_px_);
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (std::isfinite(x[i]) && std::isfinite(low[i]) && std::isfinite(high[i])) {
      upper.push_back(at(x[i], high[i]));
      lower.push_back(at(x[i], low[i]));
    } else {
      close();
    }
  }
  close();
  canvas_.unclip();
}

void PlotAxes::dots(std::span<const double> x, std::span<const double> y, const Colour& colour, double radius_px) {
  canvas_.clip(low_px_, high_px_ - low_px_);
  for (std::size_t i = 0; i < x.size(); ++i)
    if (std::isfinite(x[i]) && std::isfinite(y[i])) canvas_.disc(at(x[i], y[i]), radius_px, colour);
  canvas_.unclip();
}

void PlotAxes::bar(const Interval& x, double y, const Colour& colour, double opacity) {
  canvas_.clip(low_px_, high_px_ - low_px_);
  canvas_.area(rectangle(at(x.low, y), {x_.pixel(x.high), high_px_.y()}), colour, opacity);
  canvas_.unclip();
}

void PlotAxes::line(const Vector2d& from, const Vector2d& to, const Colour& colour, double width_px, double opacity) {
  canvas_.clip(low_px_, high_px_ - low_px_);
  canvas_.line(at(from.x(), from.y()), at(to.x(), to.y()), width_px, colour, opacity);
  canvas_.unclip();
}

void PlotAxes::level(double y, const Colour& colour) { line({x_.values().low, y}, {x_.values().high, y}, colour); }

void PlotAxes::legend(const std::string& name, const Colour& colour) {
  constexpr double kKey_px = 18, kGap_px = 16;
  legend_px_ += canvas_.text_width_px(name, kTickText_px) + kKey_px + kGap_px;
  const Vector2d key(high_px_.x() - legend_px_ + kGap_px, low_px_.y() - 16);
  canvas_.line(key, key + Vector2d(kKey_px - 6, 0), 3, colour);
  canvas_.text(key + Vector2d(kKey_px, 4.5), name, kTickText_px, kFaintInk, Canvas::Anchor::left);
}

void PlotAxes::say_nothing_known() {
  canvas_.text(0.5 * (low_px_ + high_px_), "not known", kTitleText_px, kFaintInk, Canvas::Anchor::middle);
}

}  // namespace lxd
