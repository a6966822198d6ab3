// SPDX-License-Identifier: Apache-2.0
// From numbers to pixels, and the round numbers that stand beside an axis.
#pragma once

#include <string>
#include <vector>

#include "backend/overview_view.hpp"

namespace lxd {

enum class ScaleKind { linear, logarithmic };

struct Tick {
  double value = 0;
  std::string text;
};

class PlotScale {
 public:
  // begin_px: where values.low is. Of a logarithmic scale both values are positive. An empty or broken interval becomes
  // one around its lower end.
  PlotScale(Interval values, double begin_px, double end_px, ScaleKind kind = ScaleKind::linear);

  [[nodiscard]] double pixel(double value) const;  // what a logarithmic scale does not have lies at its begin
  [[nodiscard]] const Interval& values() const { return values_; }
  // About `wanted` multiples of 1, 2 or 5 times a power of ten within the values; powers of ten on a logarithmic scale.
  [[nodiscard]] std::vector<Tick> ticks(int wanted) const;

 private:
  [[nodiscard]] std::vector<Tick> powers() const;

  Interval values_;
  double begin_px_, end_px_;
  ScaleKind kind_;
};

// All finite values with a margin; {0, 1} without any.
Interval covering(const std::vector<double>& values, double margin = 0.05);

}  // namespace lxd
