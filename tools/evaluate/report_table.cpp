// SPDX-License-Identifier: Apache-2.0
// The evaluation as a table for people.
#include <iterator>

#include <fmt/format.h>

#include "tools/evaluate/evaluate.hpp"
#include "tools/evaluate/units.hpp"

namespace lxd {
namespace {

// One line: a name, then columns.
class Table {
 public:
  void head(const char* name) {
    line("{}{:<26}{:>10}{:>10}{:>10}{:>10}{:>10}\n", text_.empty() ? "" : "\n", name, "rmse", "mean", "median", "p95",
         "max");
  }
  void row(const std::string& name, const Statistics& s, double unit = 1) {
    line("{:<26}{:>10.4f}{:>10.4f}{:>10.4f}{:>10.4f}{:>10.4f}\n", name, unit * s.rmse, unit * s.mean, unit * s.median,
         unit * s.p95, unit * s.max);
  }
  template <typename... Columns>
  void line(fmt::format_string<Columns...> format, Columns&&... columns) {
    fmt::format_to(std::back_inserter(text_), format, std::forward<Columns>(columns)...);
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

void add_path(Table& table, const EvaluationReport& r) {
  table.line("{:<26}{} of {} poses matched ({} outside of truth), {:.1f} s\n", "association", r.matched,
             r.estimate_poses, r.unmatched, r.duration_s);
  table.line("{:<26}{:.2f} m true, {:.2f} m estimated\n", "path", r.truth_path_m, r.estimate_path_m);
  table.head("absolute (SE(3) aligned)");
  table.row("position m", r.ate_m);
  if (!r.orientation_rad) return;
  table.row("orientation deg", *r.orientation_rad, kDegrees);
  table.line("{:<26}{:>10.4f}  aligned by the first pose\n", "end of path m", r.final_drift_m);
}

void add_relative(Table& table, const EvaluationReport& r) {
  if (r.relative.empty()) return;
  table.head("relative");
  for (const RelativeError& e : r.relative) {
    table.row(fmt::format("over {:g} {}: m", e.delta, e.unit), e.translation_m);
    if (e.rotation_rad) table.row(fmt::format("over {:g} {}: deg", e.delta, e.unit), *e.rotation_rad, kDegrees);
  }
}

void add_kitti(Table& table, const KittiErrors& kitti) {
  table.line("\n{:<26}{:>10}{:>10}{:>10}\n", "KITTI segments", "%", "deg/m", "segments");
  std::size_t segments = 0;
  for (const SegmentError& e : kitti.lengths) {
    table.line("{:<26}{:>10.4f}{:>10.5f}{:>10}\n", fmt::format("{:g} m", e.length_m), kPerCent * e.translation_ratio,
               kDegrees * e.rotation_rad_per_m, e.segments);
    segments += e.segments;
  }
  table.line("{:<26}{:>10.4f}{:>10.5f}{:>10}\n", "all", kPerCent * kitti.translation_ratio,
             kDegrees * kitti.rotation_rad_per_m, segments);
}

void add_consistency(Table& table, const Consistency& c) {
  table.line("\n{:<26}{:>10}{:>10}{:>10}\n", "consistency (NEES)", "pose", "rotation", "position");
  table.line("{:<26}{:>10}{:>10}{:>10}\n", "wanted", 6, 3, 3);
  table.line("{:<26}{:>10.3f}{:>10.3f}{:>10.3f}\n", "average", c.nees_pose, c.nees_rotation, c.nees_position);
  table.line("{:<26}[{:.3f}, {:.3f}] for {} independent poses, {} skipped\n", "95 % of the average", c.lower_95,
             c.upper_95, c.poses, c.skipped);
  table.line("{:<26}{:>9.1f}%\n", "poses within 95 %", kPerCent * c.share_within_95);
}

void add_innovation(Table& table, const InnovationConsistency& c) {
  table.line("\n{:<26}{:>10}{:>10}{:>10}\n", "innovations (NIS)", "average", "wanted", "in 95 %");
  table.line("{:<26}{:>10.3f}{:>10}{:>9.1f}%\n", "per dimension", c.nis_per_dimension, 1, kPerCent * c.share_within_95);
  table.line("{:<26}[{:.3f}, {:.3f}] for {} independent updates\n", "95 % of the average", c.lower_95, c.upper_95,
             c.updates);
}

void add_calibration(Table& table, const MeshCalibration& c) {
  table.line("\n{:<26}{:>10}{:>10}{:>10}{:>10}\n", "mesh's own variance", "ratio", "1 sigma", "2 sigma", "3 sigma");
  table.line("{:<26}{:>10}{:>9.1f}%{:>9.1f}%{:>9.1f}%\n", "wanted", 1, kPerCent * kGaussianWithin[0],
             kPerCent * kGaussianWithin[1], kPerCent * kGaussianWithin[2]);
  table.line("{:<26}{:>10.3f}{:>9.1f}%{:>9.1f}%{:>9.1f}%\n", "error over sigma", c.error_ratio,
             kPerCent * c.share_within[0], kPerCent * c.share_within[1], kPerCent * c.share_within[2]);
  table.line("{:<26}{:.3f} mean, {:.3f} median (wanted 1, {:.3f}); {} of {} samples on no surface\n", "squared",
             c.mean_square, c.median_square, kMedianOfChiSquared1, c.beyond_reach, c.samples);
  table.line("{:<26}", "claimed sigma mm, deciles");
  for (const CalibrationBin& bin : c.deciles) table.line("{:>7.1f}", kMillimetres * bin.claimed_rms_m);
  table.line("\n{:<26}", "actual rms mm");
  for (const CalibrationBin& bin : c.deciles) table.line("{:>7.1f}", kMillimetres * bin.actual_rms_m);
  table.line("\n");
}

void add_mesh(Table& table, const MeshErrors& m) {
  table.head("mesh");
  table.row("accuracy m", m.accuracy_m);
  table.row("completeness m", m.completeness_m);
  table.line("{:<26}{} of {} world samples in view; mesh of {} vertices, {} faces, {:.1f} m2\n", "counted",
             m.world_samples_counted, m.world_samples, m.vertices, m.faces, m.area_m2);
  table.line("{:<26}{:>10}{:>10}{:>10}\n", "within", "precision", "recall", "F-score");
  for (const ThresholdScore& s : m.scores)
    table.line("{:<26}{:>9.2f}%{:>9.2f}%{:>9.2f}%\n", fmt::format("{:g} cm", kPerCent * s.threshold_m),
               kPerCent * s.precision, kPerCent * s.recall, kPerCent * s.f_score);
  if (m.calibration) add_calibration(table, *m.calibration);
}

}  // namespace

std::string to_table(const EvaluationReport& report) {
  Table table;
  add_path(table, report);
  add_relative(table, report);
  if (report.kitti) add_kitti(table, *report.kitti);
  if (report.consistency) add_consistency(table, *report.consistency);
  if (report.innovation) add_innovation(table, *report.innovation);
  if (report.mesh) add_mesh(table, *report.mesh);
  return table.text();
}

}  // namespace lxd
