// SPDX-License-Identifier: Apache-2.0
// The whole of an evaluation: load, associate, align, measure.
#include "tools/evaluate/evaluate.hpp"

#include <array>

#include <fmt/format.h>

#include "tools/evaluate/align.hpp"
#include "tools/evaluate/associate.hpp"
#include "tools/evaluate/consistency.hpp"
#include "tools/evaluate/trajectory_errors.hpp"
#include "tools/evaluate/triangle_mesh.hpp"

namespace lxd {
namespace {

constexpr std::size_t kPairsMin = 3;  // any two points align with any other two as far apart
constexpr std::array<double, 2> kDeltas_m{1, 10};
constexpr std::array<double, 2> kDeltas_s{1, 10};

std::vector<double> elapsed_s(std::span<const PosePair> pairs) {
  std::vector<double> elapsed;
  for (const PosePair& pair : pairs) elapsed.push_back((pair.stamp - pairs.front().stamp).seconds());
  return elapsed;
}

void add_relative(EvaluationReport& report, std::span<const PosePair> pairs, std::span<const double> progress,
                  std::span<const double> deltas, const std::string& unit) {
  for (const double delta : deltas) {
    RelativeError error = relative_errors(pairs, progress, delta);
    error.unit = unit;
    if (error.translation_m.count > 0) report.relative.push_back(std::move(error));
  }
}

// What needs truth's attitude.
void add_oriented(EvaluationReport& report, std::span<const PosePair> pairs, const Pose& T_truth_map) {
  report.orientation_rad = orientation_errors(pairs, T_truth_map);
  const PosePair& last = pairs.back();
  report.final_drift_m = (last.truth.p - align_first(pairs) * last.estimate.p).norm();
  add_relative(report, pairs, truth_way(pairs), kDeltas_m, "m");
  add_relative(report, pairs, elapsed_s(pairs), kDeltas_s, "s");
  KittiErrors kitti = kitti_errors(pairs);
  if (!kitti.lengths.empty()) report.kitti = std::move(kitti);
}

EvaluationReport measure_path(const Association& association, const Pose& T_truth_map, bool oriented) {
  const std::span<const PosePair> pairs = association.pairs;
  EvaluationReport report;
  report.matched = pairs.size();
  report.unmatched = association.unmatched;
  report.duration_s = (pairs.back().stamp - pairs.front().stamp).seconds();
  report.truth_path_m = truth_way(pairs).back();
  report.estimate_path_m = estimate_way(pairs).back();
  report.ate_m = absolute_errors(pairs, T_truth_map);
  if (oriented) add_oriented(report, pairs, T_truth_map);
  return report;
}

std::optional<std::filesystem::path> covariance_file(const EvaluateOptions& options) {
  if (options.covariance) return options.covariance;
  std::filesystem::path beside = options.estimate;
  beside.replace_filename(options.estimate.stem().string() + "_covariance.txt");
  if (std::filesystem::exists(beside)) return beside;
  return std::nullopt;
}

Status add_consistency(EvaluationReport& report, const EvaluateOptions& options, std::span<const PosePair> pairs) {
  const auto file = covariance_file(options);
  if (!file) return success();
  const Result<std::vector<StampedCovariance>> covariances = load_covariances(*file);
  if (!covariances.ok()) return covariances.error();
  report.consistency = consistency(pairs, *covariances);
  return success();
}

Status add_mesh(EvaluationReport& report, const EvaluateOptions& options, std::span<const PosePair> pairs,
                const Pose& T_truth_map) {
  if (!options.mesh) return success();
  Result<TriangleMesh> mesh = load_mesh_ply(*options.mesh);
  if (!mesh.ok()) return mesh.error();
  const Result<TriangleMesh> world = load_mesh_ply(*options.world);
  if (!world.ok()) return world.error();
  mesh->transform(T_truth_map);
  std::vector<Eigen::Vector3d> path_m;
  for (const PosePair& pair : pairs) path_m.push_back(pair.truth.p);
  report.mesh = mesh_errors(*mesh, *world, path_m, options.mesh_errors);
  return success();
}

}  // namespace

Result<EvaluationReport> evaluate(const EvaluateOptions& options) {
  if (options.mesh.has_value() != options.world.has_value())
    return Error{
        fmt::format("found {} alone, wanted --mesh and --world together", options.mesh ? "--mesh" : "--world")};
  const Result<Trajectory> estimate = load_tum(options.estimate);
  if (!estimate.ok()) return estimate.error();
  const Result<Trajectory> truth = load_tum(options.truth);
  if (!truth.ok()) return truth.error();
  const Association association = associate(*estimate, *truth, options.truth_gap_max);
  if (association.pairs.size() < kPairsMin)
    return Error{fmt::format("{}: {} of {} poses lie within the time of {}, wanted {} or more",
                             options.estimate.string(), association.pairs.size(), estimate->poses.size(),
                             options.truth.string(), kPairsMin)};
  const bool oriented = estimate->oriented && truth->oriented;
  const Pose T_truth_map = align_path(association.pairs, oriented);
  EvaluationReport report = measure_path(association, T_truth_map, oriented);
  report.estimate_poses = estimate->poses.size();
  report.truth_poses = truth->poses.size();
  if (oriented)
    if (const Status added = add_consistency(report, options, association.pairs); !added.ok()) return added.error();
  if (const Status added = add_mesh(report, options, association.pairs, T_truth_map); !added.ok()) return added.error();
  return report;
}

}  // namespace lxd
