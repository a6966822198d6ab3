// SPDX-License-Identifier: Apache-2.0
// Linear and logarithmic scales.
#include "tools/evaluate/plots/plot_scale.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

namespace lxd {
namespace {

Interval sound(Interval values, ScaleKind kind) {
  if (!std::isfinite(values.low) || !std::isfinite(values.high)) values = {0, 1};
  if (kind == ScaleKind::logarithmic) {
    constexpr double kSmallest = 1e-12;
    values.low = std::max(values.low, kSmallest);
    return {values.low, std::max(values.high, 10 * values.low)};
  }
  const double span_min = 1e-9 * std::max(1.0, std::abs(values.low));
  if (values.high - values.low < span_min) return {values.low - 0.5, values.low + 0.5};
  return values;
}

// 1, 2 or 5 times a power of ten, not below `step`.
double round_up(double step) {
  const double power = std::pow(10, std::floor(std::log10(step)));
  constexpr double kRounding = 1 + 1e-9;
  for (const double digit : {1.0, 2.0, 5.0})
    if (step <= digit * power * kRounding) return digit * power;
  return 10 * power;
}

}  // namespace

PlotScale::PlotScale(Interval values, double begin_px, double end_px, ScaleKind kind)
    : values_(sound(values, kind)), begin_px_(begin_px), end_px_(end_px), kind_(kind) {}

double PlotScale::pixel(double value) const {
  double share = 0;
  if (kind_ == ScaleKind::linear)
    share = (value - values_.low) / (values_.high - values_.low);
  else if (value > 0)
    share = std::log(value / values_.low) / std::log(values_.high / values_.low);
  return begin_px_ + share * (end_px_ - begin_px_);
}

std::vector<Tick> PlotScale::powers() const {
  std::vector<Tick> ticks;
  constexpr double kRounding = 1e-9;
  const int first = static_cast<int>(std::ceil(std::log10(values_.low) - kRounding));
  const int last = static_cast<int>(std::floor(std::log10(values_.high) + kRounding));
  for (int power = first; power <= last; ++power)
    ticks.push_back({std::pow(10, power), fmt::format("{:g}", std::pow(10, power))});
  return ticks;
}

std::vector<Tick> PlotScale::ticks(int wanted) const {
  if (kind_ == ScaleKind::logarithmic) return powers();
  const double step = round_up((values_.high - values_.low) / wanted);
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  std::vector<Tick> ticks;
  const auto first = static_cast<std::int64_t>(std::ceil(values_.low / step - 1e-9));
  for (std::int64_t i = first; static_cast<double>(i) * step <= values_.high + 1e-9 * step; ++i) {
    const double value = static_cast<double>(i) * step;
    ticks.push_back({value, fmt::format("{:.{}f}", value, decimals)});
  }
  return ticks;
}

Interval covering(const std::vector<double>& values, double margin) {
  bool found = false;
  Interval all{0, 1};
  for (const double v : values) {
    if (!std::isfinite(v)) continue;
    all = found ? Interval{std::min(all.low, v), std::max(all.high, v)} : Interval{v, v};
    found = true;
  }
  if (!found) return all;
  const double more = margin * (all.high - all.low);
  return {all.low - more, all.high + more};
}

}  // namespace lxd
