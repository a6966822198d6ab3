// SPDX-License-Identifier: Apache-2.0
// A picture of many panels in two columns, under a title.
#pragma once

#include <filesystem>
#include <string>

#include "tools/evaluate/plots/plot_axes.hpp"

namespace lxd {

class PlotSheet {
 public:
  static constexpr int kWidth_px = 1800;
  static constexpr int kTitle_px = 92;
  static constexpr int kRow_px = 236;
  static constexpr int kColumns = 2;

  PlotSheet(int rows, const std::string& title, const std::string& subtitle);

  [[nodiscard]] PanelPlace place(int row, int column) const;
  [[nodiscard]] Canvas& canvas() { return canvas_; }

 private:
  Canvas canvas_;
};

}  // namespace lxd
