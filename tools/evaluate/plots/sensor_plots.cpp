// SPDX-License-Identifier: Apache-2.0
// The sheet of sensors.
#include "tools/evaluate/plots/sensor_plots.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tools/evaluate/plots/plot_sheet.hpp"
#include "tools/evaluate/units.hpp"

namespace lxd {
namespace {

constexpr int kRowsMax = 100;            // Cairo's pictures end at 32767 pixels
constexpr std::size_t kBins = 80;        // of a histogram
constexpr double kOutlierShare = 0.002;  // at either end of a histogram

using Values = std::vector<double>;

Values finite_values(const SensorPanel& panel) {
  Values all;
  for (const TimeSeries& series : panel.series)
    std::ranges::copy_if(series.values, std::back_inserter(all), [](double v) { return std::isfinite(v); });
  return all;
}

Interval time_span(std::span<const SensorPanel> panels) {
  Values ends;
  for (const SensorPanel& panel : panels)
    for (const TimeSeries& series : panel.series)
      if (panel.kind != SensorPanel::Kind::histogram && !series.t_s.empty())
        ends.insert(ends.end(), {series.t_s.front(), series.t_s.back()});
  return covering(ends, 0);
}

const Colour& colour_of(std::size_t series) { return kCurves[series % kCurves.size()]; }

void add_legend(PlotAxes& axes, const SensorPanel& panel) {
  for (std::size_t i = panel.series.size(); i-- > 0;) axes.legend(panel.series[i].name, colour_of(i));
}

std::string count_text(const SensorPanel& panel) {
  std::size_t samples = 0;
  for (const TimeSeries& series : panel.series) samples = std::max(samples, series.values.size());
  return fmt::format("{} samples", samples);
}

void draw_over_time(PlotSheet& sheet, const PanelPlace& place, const SensorPanel& panel, const Interval& span_s) {
  const Values all = finite_values(panel);
  PlotAxes axes(sheet.canvas(), place, {panel.title, "s", panel.unit, count_text(panel)}, {span_s, covering(all)});
  if (all.empty()) return axes.say_nothing_known();
  constexpr double kDot_px = 2.2;
  for (std::size_t i = 0; i < panel.series.size(); ++i) {
    const TimeSeries& series = panel.series[i];
    if (panel.kind == SensorPanel::Kind::dots)
      axes.dots(series.t_s, series.values, colour_of(i), kDot_px);
    else
      axes.curve(series.t_s, series.values, colour_of(i), 1.3);
  }
  add_legend(axes, panel);
}

struct Histogram {
  Interval range;
  std::vector<Values> share;  // of each series' samples in each bin, in per cent
  std::size_t outside = 0;

  [[nodiscard]] double width() const { return (range.high - range.low) / kBins; }
};

// The inner part by rank, so that one outlier does not squeeze all others into a bin.
Histogram histogram_of(const SensorPanel& panel, const Values& all) {
  constexpr double kSpanMin = 1e-6;
  Histogram h{inner_interval(all, kOutlierShare), {}, 0};
  const double margin = std::max(0.05 * (h.range.high - h.range.low), kSpanMin * std::max(1.0, std::abs(h.range.low)));
  h.range = {h.range.low - margin, h.range.high + margin};
  for (const TimeSeries& series : panel.series) {
    Values& share = h.share.emplace_back(kBins, 0.0);
    for (const double v : series.values) {
      if (!std::isfinite(v)) continue;
      const double bin = std::floor((v - h.range.low) / h.width());
      if (bin >= 0 && bin < kBins)
        share[static_cast<std::size_t>(bin)] += kPerCent / static_cast<double>(series.values.size());
      else
        ++h.outside;
    }
  }
  return h;
}

std::string outside_text(const Histogram& h, const Values& all) {
  if (h.outside == 0) return "";
  const auto [least, most] = std::ranges::minmax(all);
  return fmt::format("{} beyond, from {:.3g} to {:.3g}", h.outside, least, most);
}

void draw_histogram(PlotSheet& sheet, const PanelPlace& place, const SensorPanel& panel) {
  const Values all = finite_values(panel);
  const Histogram h = all.empty() ? Histogram{{0, 1}, {}, 0} : histogram_of(panel, all);
  double most = 0;
  for (const Values& share : h.share) most = std::max(most, std::ranges::max(share));
  PlotAxes axes(sheet.canvas(), place,
                {panel.title, panel.unit, "% of the samples", all.empty() ? "" : outside_text(h, all)},
                {h.range, {0, std::max(1.1 * most, 1e-6)}});
  if (all.empty()) return axes.say_nothing_known();
  constexpr double kOpacity = 0.55;
  for (std::size_t i = 0; i < h.share.size(); ++i)
    for (std::size_t bin = 0; bin < kBins; ++bin) {
      const double begin = h.range.low + static_cast<double>(bin) * h.width();
      axes.bar({begin, begin + h.width()}, h.share[i][bin], colour_of(i), kOpacity);
    }
  add_legend(axes, panel);
}

}  // namespace

TimeSeries intervals_ms(const std::string& name, std::span<const RigTime> times, RigTime origin) {
  constexpr double kMilliseconds = 1000;
  TimeSeries series{name, {}, {}};
  for (std::size_t i = 1; i < times.size(); ++i) {
    series.t_s.push_back((times[i] - origin).seconds());
    series.values.push_back(kMilliseconds * (times[i] - times[i - 1]).seconds());
  }
  return series;
}

TimeSeries latency_ms(const std::string& name, std::span<const RigTime> taken, std::span<const RigTime> received,
                      RigTime origin) {
  constexpr double kMilliseconds = 1000;
  TimeSeries series{name, {}, {}};
  for (std::size_t i = 0; i < std::min(taken.size(), received.size()); ++i) {
    series.t_s.push_back((taken[i] - origin).seconds());
    series.values.push_back(kMilliseconds * (received[i] - taken[i]).seconds());
  }
  return series;
}

Status write_sensor_plots(const std::filesystem::path& png, std::span<const SensorPanel> panels,
                          const std::string& title, const std::string& subtitle) {
  const int rows = static_cast<int>((panels.size() + PlotSheet::kColumns - 1) / PlotSheet::kColumns);
  if (rows == 0 || rows > kRowsMax)
    return Error{fmt::format("{}: found {} panels, wanted 1 to {}", png.string(), panels.size(),
                             kRowsMax * PlotSheet::kColumns)};
  PlotSheet sheet(rows, title, subtitle);
  const Interval span_s = time_span(panels);
  for (std::size_t i = 0; i < panels.size(); ++i) {
    const auto index = static_cast<int>(i);
    const PanelPlace place = sheet.place(index / PlotSheet::kColumns, index % PlotSheet::kColumns);
    if (panels[i].kind == SensorPanel::Kind::histogram)
      draw_histogram(sheet, place, panels[i]);
    else
      draw_over_time(sheet, place, panels[i], span_s);
  }
  return sheet.canvas().write_png(png);
}

}  // namespace lxd
