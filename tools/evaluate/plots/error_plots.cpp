// SPDX-License-Identifier: Apache-2.0
// The sheet of errors: which rows there are, and what of the path goes into them. The mesh's panels: mesh_plots.
#include "tools/evaluate/plots/error_plots.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "tools/evaluate/consistency.hpp"
#include "tools/evaluate/plots/mesh_plots.hpp"
#include "tools/evaluate/plots/plot_sheet.hpp"
#include "tools/evaluate/units.hpp"

namespace lxd {
namespace {

using Values = std::vector<double>;

constexpr double kSigmas = 3;
constexpr double kSpreadOpacity = 0.20;

template <typename Item, typename Get>
Values column(const std::vector<Item>& items, Get get) {
  Values values;
  values.reserve(items.size());
  for (const Item& item : items) values.push_back(get(item));
  return values;
}

double largest(const Values& values) {
  double most = 0;
  for (const double v : values)
    if (std::isfinite(v)) most = std::max(most, std::abs(v));
  return most;
}

bool any_known(const Values& values) {
  return std::ranges::any_of(values, [](double v) { return std::isfinite(v); });
}

Interval span_s(const EvaluationReport& r) { return {0, std::max(r.duration_s, 1e-9)}; }

struct Component {
  const char* title;
  int index;  // into [rotation, position]
  const char* unit;
  double factor;
};
constexpr std::array<std::array<Component, 2>, 3> kComponents{
    {{{{"position error x", 3, "cm", kCentimetres}, {"attitude error about x", 0, "deg", kDegrees}}},
     {{{"position error y", 4, "cm", kCentimetres}, {"attitude error about y", 1, "deg", kDegrees}}},
     {{{"position error z", 5, "cm", kCentimetres}, {"attitude error about z", 2, "deg", kDegrees}}}}};

// The error stays legible where the filter is in great doubt, and the bounds where it is off by far.
double half_height(const Values& error, const Values& bound) {
  constexpr double kRoom = 1.15, kBoundsMost = 4, kSmallest = 1e-6;
  return kRoom * std::max({largest(error), std::min(largest(bound), kBoundsMost * largest(error)), kSmallest});
}

void draw_component(PlotSheet& sheet, const PanelPlace& place, const EvaluationReport& r, const Component& c) {
  const Values t = column(r.poses, [](const PoseErrors& p) { return p.t_s; });
  const Values error = column(r.poses, [&](const PoseErrors& p) { return c.factor * p.since_start[c.index]; });
  const Values high = column(r.poses, [&](const PoseErrors& p) { return kSigmas * c.factor * p.sigma[c.index]; });
  const Values low = column(r.poses, [&](const PoseErrors& p) { return -kSigmas * c.factor * p.sigma[c.index]; });
  const double half = half_height(error, high);
  PlotAxes axes(sheet.canvas(), place, {c.title, "s", c.unit, c.index % 3 == 0 ? "aligned by the first pose" : ""},
                {span_s(r), {-half, half}});
  const Colour& colour = kCurves[static_cast<std::size_t>(c.index % 3)];
  if (any_known(high)) {
    axes.band(t, low, high, colour, kSpreadOpacity);
    axes.legend("3 sigma of the filter", 0.45F * colour);
  }
  axes.curve(t, error, colour);
  axes.legend("error", colour);
  if (!any_known(error)) axes.say_nothing_known();
}

void draw_absolute(PlotSheet& sheet, int row, const EvaluationReport& r) {
  const Values t = column(r.poses, [](const PoseErrors& p) { return p.t_s; });
  const Values position = column(r.poses, [](const PoseErrors& p) { return kCentimetres * p.position_m; });
  const Values turn = column(r.poses, [](const PoseErrors& p) { return kDegrees * p.turn_rad; });
  constexpr double kRoom = 1.1;
  const auto draw = [&](int where, const PanelText& text, const Values& values, double rmse, const Colour& colour) {
    PlotAxes axes(sheet.canvas(), sheet.place(row, where), text,
                  {span_s(r), {0, std::max(kRoom * largest(values), 1e-6)}});
    axes.curve(t, values, colour);
    if (any_known(values)) {
      axes.level(rmse, kInk);
      axes.legend(fmt::format("rms {:.3g} {}", rmse, text.unit_y), kInk);
    } else {
      axes.say_nothing_known();
    }
  };
  draw(0, {"position error after alignment", "s", "cm", "of the whole path"}, position, kCentimetres * r.ate_m.rmse,
       kCurves[3]);
  draw(1, {"attitude error after alignment", "s", "deg", "of the whole path"}, turn,
       r.orientation_rad ? kDegrees * r.orientation_rad->rmse : 0, kCurves[4]);
}

void draw_segments(PlotSheet& sheet, int row, const KittiErrors& kitti) {
  const Values length = column(kitti.lengths, [](const SegmentError& e) { return e.length_m; });
  const auto draw = [&](int where, const PanelText& text, const Values& values, const Colour& colour) {
    PlotAxes axes(sheet.canvas(), sheet.place(row, where), text,
                  {{0, 1.05 * length.back()}, {0, std::max(1.2 * largest(values), 1e-9)}});
    axes.curve(length, values, colour);
    axes.dots(length, values, colour, 4);
  };
  draw(0, {"drift over segments of the way", "m", "%", "KITTI's measure: translation"},
       column(kitti.lengths, [](const SegmentError& e) { return kPerCent * e.translation_ratio; }), kCurves[0]);
  draw(1, {"turn over segments of the way", "m", "deg/m", "KITTI's measure: rotation"},
       column(kitti.lengths, [](const SegmentError& e) { return kDegrees * e.rotation_rad_per_m; }), kCurves[1]);
}

struct Normalised {
  PanelText text;
  Values t_s, values;
  double low, wanted, high;  // 95 % of a consistent filter's lie between
};

void draw_normalised(PlotSheet& sheet, const PanelPlace& place, const EvaluationReport& r, const Normalised& n,
                     const Colour& colour) {
  const bool known = any_known(n.values);
  Values positive = n.values;
  std::erase_if(positive, [](double v) { return !(v > 0); });
  Interval y = covering(positive, 0);
  y = known ? Interval{std::min(y.low, 0.5 * n.low), std::max(y.high, 2 * n.high)} : Interval{0.1, 100};
  PlotAxes axes(sheet.canvas(), place, n.text, {span_s(r), y, ScaleKind::linear, ScaleKind::logarithmic});
  if (!known) return axes.say_nothing_known();
  const Values ends{0, r.duration_s};
  axes.band(ends, Values{n.low, n.low}, Values{n.high, n.high}, kStartMark, 0.14);
  axes.level(n.wanted, kStartMark);
  axes.curve(n.t_s, n.values, colour, 1.2);
  axes.legend("95 % of a consistent filter", 0.6F * kStartMark);
}

void draw_consistency(PlotSheet& sheet, int row, const EvaluationReport& r) {
  constexpr double kPoseDimensions = 6;
  Normalised nees{{"NEES of the pose", "s", "", ""},
                  column(r.poses, [](const PoseErrors& p) { return p.t_s; }),
                  column(r.poses, [](const PoseErrors& p) { return p.nees; }),
                  kChiSquared6Low,
                  kPoseDimensions,
                  kChiSquared6High};
  if (r.consistency) nees.text.remark = fmt::format("average {:.3g}, wanted 6", r.consistency->nees_pose);
  draw_normalised(sheet, sheet.place(row, 0), r, nees, kCurves[5]);
  Normalised nis{{"NIS of the update", "s", "", ""},
                 column(r.innovations, [](const InnovationAt& i) { return i.t_s; }),
                 column(r.innovations, [](const InnovationAt& i) { return i.nis / i.dimensions; }),
                 0,
                 1,
                 0};
  if (r.innovation) {
    const double dimensions = r.innovation->dimensions_mean;
    nis.low = chi_squared_quantile(dimensions, -kZ97_5) / dimensions;
    nis.high = chi_squared_quantile(dimensions, kZ97_5) / dimensions;
    nis.text.remark = fmt::format("per dimension; average {:.3g}, wanted 1", r.innovation->nis_per_dimension);
  }
  draw_normalised(sheet, sheet.place(row, 1), r, nis, kCurves[5]);
}

std::string subtitle_of(const EvaluationReport& r) {
  std::string line = fmt::format("{} poses over {:.1f} s and {:.1f} m   ·   position rms {:.3g} cm", r.matched,
                                 r.duration_s, r.truth_path_m, kCentimetres * r.ate_m.rmse);
  if (r.orientation_rad) line += fmt::format("   ·   attitude rms {:.3g}°", kDegrees * r.orientation_rad->rmse);
  if (r.kitti) line += fmt::format("   ·   drift {:.3g} %", kPerCent * r.kitti->translation_ratio);
  if (r.mesh)
    for (const ThresholdScore& s : r.mesh->scores)
      line += fmt::format("   ·   F({:g} cm) {:.1f} %", kCentimetres * s.threshold_m, kPerCent * s.f_score);
  return line;
}

}  // namespace

Status write_error_plots(const std::filesystem::path& png, const EvaluationReport& r, const std::string& title) {
  const bool oriented = r.orientation_rad.has_value();
  const bool consistent = r.consistency || r.innovation;
  const int rows = (oriented ? 3 : 0) + 1 + (r.kitti ? 1 : 0) + (consistent ? 1 : 0) + (r.mesh ? 1 : 0);
  PlotSheet sheet(rows, title, subtitle_of(r));
  int row = 0;
  for (std::size_t i = 0; oriented && i < kComponents.size(); ++i, ++row)
    for (int side = 0; side < PlotSheet::kColumns; ++side)
      draw_component(sheet, sheet.place(row, side), r, kComponents[i][static_cast<std::size_t>(side)]);
  draw_absolute(sheet, row++, r);
  if (r.kitti) draw_segments(sheet, row++, *r.kitti);
  if (consistent) draw_consistency(sheet, row++, r);
  if (r.mesh) {
    draw_distances(sheet.canvas(), sheet.place(row, 0), *r.mesh);
    draw_reliability(sheet.canvas(), sheet.place(row, 1), *r.mesh);
  }
  return sheet.canvas().write_png(png);
}

}  // namespace lxd
