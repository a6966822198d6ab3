// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluate/plots/plot_sheet.hpp"

namespace lxd {
namespace {

constexpr int kMargin_px = 28;
constexpr int kGap_px = 24;
constexpr int kFooter_px = 18;

}  // namespace

PlotSheet::PlotSheet(int rows, const std::string& title, const std::string& subtitle)
    : canvas_(kWidth_px, kTitle_px + rows * kRow_px + kFooter_px) {
  canvas_.text({kMargin_px + 8, 42}, title, 26, kInk, Canvas::Anchor::left, true);
  canvas_.text({kMargin_px + 8, 70}, subtitle, 17, kFaintInk, Canvas::Anchor::left);
}

PanelPlace PlotSheet::place(int row, int column) const {
  constexpr double kPanel_px = (kWidth_px - 2.0 * kMargin_px - (kColumns - 1) * kGap_px) / kColumns;
  return {{kMargin_px + column * (kPanel_px + kGap_px), kTitle_px + row * kRow_px}, {kPanel_px, kRow_px}};
}

}  // namespace lxd
