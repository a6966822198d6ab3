// SPDX-License-Identifier: Apache-2.0
#include "tools/evaluate/plots/mesh_plots.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tools/evaluate/units.hpp"

namespace lxd {
namespace {

constexpr std::size_t kBins = 60;
constexpr double kShownTo = 0.97;  // of the distances; the rest is named

}  // namespace

void draw_distances(Canvas& canvas, const PanelPlace& place, const MeshErrors& mesh) {
  const auto count = static_cast<double>(std::max<std::size_t>(mesh.distances_m.size(), 1));
  const double end_mm = kMillimetres * inner_interval(mesh.distances_m, 1 - kShownTo).high;
  const double width_mm = std::max(end_mm, 1e-6) / kBins;
  std::vector<double> share(kBins, 0.0);
  for (const double d : mesh.distances_m)
    if (const auto bin = static_cast<std::size_t>(kMillimetres * d / width_mm); bin < kBins)
      share[bin] += kPerCent / count;
  PlotAxes axes(canvas, place,
                {"mesh to world", "mm", "% of the area",
                 fmt::format("97 % shown; rms {:.3g} mm", kMillimetres * mesh.accuracy_m.rmse)},
                {{0, kBins * width_mm}, {0, std::max(1.15 * std::ranges::max(share), 1e-6)}});
  if (mesh.distances_m.empty()) return axes.say_nothing_known();
  for (std::size_t i = 0; i < kBins; ++i) {
    const double begin = static_cast<double>(i) * width_mm;
    axes.bar({begin + 0.06 * width_mm, begin + 0.94 * width_mm}, share[i], kCurves[0], 0.75);
  }
  const double median_mm = kMillimetres * mesh.accuracy_m.median;
  axes.line({median_mm, 0}, {median_mm, kPerCent}, kInk);
  axes.legend(fmt::format("median {:.3g} mm", median_mm), kInk);
}

void draw_reliability(Canvas& canvas, const PanelPlace& place, const MeshErrors& mesh) {
  std::vector<double> claimed, actual;
  if (mesh.calibration)
    for (const CalibrationBin& bin : mesh.calibration->deciles) {
      claimed.push_back(kMillimetres * bin.claimed_rms_m);
      actual.push_back(kMillimetres * bin.actual_rms_m);
    }
  PanelText text{"error over claim of the mesh", "mm", "mm rms", ""};
  constexpr double kRoom = 1.1;
  const double x_most = claimed.empty() ? 1 : kRoom * std::ranges::max(claimed);
  const double y_most = actual.empty() ? 1 : std::max(kRoom * std::ranges::max(actual), x_most);
  if (mesh.calibration) text.remark = fmt::format("by deciles; median {:.3g} × claim", mesh.calibration->error_ratio);
  PlotAxes axes(canvas, place, text, {{0, x_most}, {0, y_most}});
  if (claimed.empty()) return axes.say_nothing_known();
  axes.line({0, 0}, {x_most, x_most}, kStartMark, 1.6);
  axes.curve(claimed, actual, kCurves[1]);
  axes.dots(claimed, actual, kCurves[1], 5);
  axes.legend("as claimed", kStartMark);
  axes.legend("actual", kCurves[1]);
}

}  // namespace lxd
