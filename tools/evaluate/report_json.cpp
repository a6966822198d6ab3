// SPDX-License-Identifier: Apache-2.0
// The evaluation as JSON for programs.

#include "tools/evaluate/evaluate.hpp"
#include "tools/evaluate/units.hpp"

namespace lxd {
namespace {

using nlohmann::json;

json statistics(const Statistics& s, double unit = 1) {
  return {{"rmse", unit * s.rmse}, {"mean", unit * s.mean}, {"median", unit * s.median},
          {"p95", unit * s.p95},   {"max", unit * s.max},   {"count", s.count}};
}

json relative(const RelativeError& e) {
  json object = {{"delta", e.delta},
                 {"unit", e.unit},
                 {"delta_mean", e.delta_mean},
                 {"translation_m", statistics(e.translation_m)}};
  if (e.rotation_rad) object["rotation_deg"] = statistics(*e.rotation_rad, kDegrees);
  return object;
}

json segment(const SegmentError& e) {
  return {{"length_m", e.length_m},
          {"segments", e.segments},
          {"translation_percent", kPerCent * e.translation_ratio},
          {"rotation_deg_per_m", kDegrees * e.rotation_rad_per_m}};
}

json kitti(const KittiErrors& k) {
  json lengths = json::array();
  for (const SegmentError& e : k.lengths) lengths.push_back(segment(e));
  return {{"translation_percent", kPerCent * k.translation_ratio},
          {"rotation_deg_per_m", kDegrees * k.rotation_rad_per_m},
          {"lengths", lengths}};
}

json nees(const Consistency& c) {
  return {{"poses", c.poses},
          {"skipped", c.skipped},
          {"pose", c.nees_pose},
          {"rotation", c.nees_rotation},
          {"position", c.nees_position},
          {"pose_bounds_95", {c.lower_95, c.upper_95}},
          {"share_within_95", c.share_within_95}};
}

json nis(const InnovationConsistency& c) {
  return {{"updates", c.updates},
          {"per_dimension", c.nis_per_dimension},
          {"dimensions_mean", c.dimensions_mean},
          {"bounds_95", {c.lower_95, c.upper_95}},
          {"share_within_95", c.share_within_95}};
}

json calibration(const MeshCalibration& c) {
  json deciles = json::array();
  for (const CalibrationBin& bin : c.deciles)
    deciles.push_back(
        {{"samples", bin.samples}, {"claimed_rms_m", bin.claimed_rms_m}, {"actual_rms_m", bin.actual_rms_m}});
  return {{"samples", c.samples},
          {"beyond_reach", c.beyond_reach},
          {"mean_square", c.mean_square},
          {"median_square", c.median_square},
          {"error_ratio", c.error_ratio},
          {"share_within_sigma", c.share_within},
          {"share_within_sigma_gaussian", kGaussianWithin},
          {"deciles", deciles}};
}

json mesh(const MeshErrors& m) {
  json scores = json::array();
  for (const ThresholdScore& s : m.scores)
    scores.push_back(
        {{"threshold_m", s.threshold_m}, {"precision", s.precision}, {"recall", s.recall}, {"f_score", s.f_score}});
  json object = {{"vertices", m.vertices},
                 {"faces", m.faces},
                 {"area_m2", m.area_m2},
                 {"accuracy_m", statistics(m.accuracy_m)},
                 {"completeness_m", statistics(m.completeness_m)},
                 {"world_samples", m.world_samples},
                 {"world_samples_counted", m.world_samples_counted},
                 {"scores", scores}};
  if (m.calibration) object["calibration"] = calibration(*m.calibration);
  return object;
}

}  // namespace

json to_json(const EvaluationReport& r) {
  json object = {{"estimate_poses", r.estimate_poses},
                 {"truth_poses", r.truth_poses},
                 {"matched", r.matched},
                 {"unmatched", r.unmatched},
                 {"duration_s", r.duration_s},
                 {"truth_path_m", r.truth_path_m},
                 {"estimate_path_m", r.estimate_path_m},
                 {"ate_m", statistics(r.ate_m)},
                 {"relative", json::array()}};
  if (r.orientation_rad) {
    object["orientation_deg"] = statistics(*r.orientation_rad, kDegrees);
    object["final_drift_m"] = r.final_drift_m;
  }
  for (const RelativeError& e : r.relative) object["relative"].push_back(relative(e));
  if (r.kitti) object["kitti"] = kitti(*r.kitti);
  if (r.consistency) object["nees"] = nees(*r.consistency);
  if (r.innovation) object["nis"] = nis(*r.innovation);
  if (r.mesh) object["mesh"] = mesh(*r.mesh);
  return object;
}

}  // namespace lxd
