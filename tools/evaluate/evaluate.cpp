// SPDX-License-Identifier: Apache-2.0
// The whole of an evaluation: load, associate, align, measure.
#include "tools/evaluate/evaluate.hpp"

#include <array>

#include <fmt/format.h>

#include "board/rig_file.hpp"
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

// What the filter left beside its path, e.g. `<stem>_covariance.txt`.
std::optional<std::filesystem::path> beside(const std::filesystem::path& estimate, const char* ending) {
  std::filesystem::path file = estimate;
  file.replace_filename(estimate.stem().string() + ending);
  if (std::filesystem::exists(file)) return file;
  return std::nullopt;
}

Status add_innovations(EvaluationReport& report, const EvaluateOptions& options, RigTime begin) {
  const auto file = beside(options.estimate, "_innovation.txt");
  if (!file) return success();
  const Result<std::vector<StampedInnovation>> innovations = load_innovations(*file);
  if (!innovations.ok()) return innovations.error();
  if (innovations->empty()) return success();
  report.innovation = consistency(*innovations);
  for (const StampedInnovation& i : *innovations)
    report.innovations.push_back({(i.stamp - begin).seconds(), i.nis, i.dimensions});
  return success();
}

Status add_consistency(EvaluationReport& report, const EvaluateOptions& options, std::span<const PosePair> pairs) {
  const auto file = options.covariance ? options.covariance : beside(options.estimate, "_covariance.txt");
  std::vector<StampedCovariance> covariances;
  if (file) {
    Result<std::vector<StampedCovariance>> loaded = load_covariances(*file);
    if (!loaded.ok()) return loaded.error();
    covariances = std::move(*loaded);
  }
  const std::vector<FilterError> errors = filter_errors(pairs, covariances);
  if (file) report.consistency = consistency(errors);
  for (std::size_t i = 0; i < errors.size(); ++i) {
    report.poses[i].since_start = errors[i].error;
    if (errors[i].covariance != nullptr)
      report.poses[i].sigma = errors[i].covariance->covariance.diagonal().cwiseSqrt();
    if (i > 0) report.poses[i].nees = nees(errors[i]).value_or(PoseErrors::kUnknown);
  }
  return success();
}

std::vector<PoseErrors> pose_errors(std::span<const PosePair> pairs, const Pose& T_truth_map, bool oriented) {
  const std::vector<double> times_s = elapsed_s(pairs), way_m = truth_way(pairs);
  std::vector<PoseErrors> errors(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Pose estimate = T_truth_map * pairs[i].estimate;
    PoseErrors& error = errors[i];
    error.t_s = times_s[i];
    error.way_m = way_m[i];
    error.position_m = (pairs[i].truth.p - estimate.p).norm();
    if (oriented) error.turn_rad = angle_between(pairs[i].truth.R, estimate.R);
  }
  return errors;
}

Result<std::vector<LidarView>> views_of(const EvaluateOptions& options) {
  if (!options.rig) return options.mesh_errors.lidars;
  const RigFile file = load_rig(options.rig->string());
  if (!file.ok()) return Error{text_of(file.problems)};
  return lidar_views(file.rig, options.mesh_errors.view_range_m);
}

Status add_mesh(EvaluationReport& report, const EvaluateOptions& options, std::span<const PosePair> pairs,
                const Pose& T_truth_map) {
  if (!options.mesh) return success();
  Result<std::vector<LidarView>> lidars = views_of(options);
  if (!lidars.ok()) return lidars.error();
  Result<TriangleMesh> mesh = load_mesh_ply(*options.mesh);
  if (!mesh.ok()) return mesh.error();
  const Result<TriangleMesh> world = load_mesh_ply(*options.world);
  if (!world.ok()) return world.error();
  mesh->transform(T_truth_map);
  std::vector<Pose> path;
  for (const PosePair& pair : pairs) path.push_back(pair.truth);
  MeshErrorOptions mesh_options = options.mesh_errors;
  mesh_options.lidars = std::move(*lidars);
  report.mesh = mesh_errors(*mesh, *world, path, mesh_options);
  return success();
}

Status check(const EvaluateOptions& options) {
  if (options.mesh.has_value() != options.world.has_value())
    return Error{
        fmt::format("found {} alone, wanted --mesh and --world together", options.mesh ? "--mesh" : "--world")};
  if (options.rig && !options.mesh) return Error{"found --rig alone, wanted --mesh and --world with it"};
  return success();
}

}  // namespace

Result<EvaluationReport> evaluate(const EvaluateOptions& options) {
  if (const Status sound = check(options); !sound.ok()) return sound.error();
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
  if (options.rig && !oriented)
    return Error{fmt::format("{}: found no orientations, wanted them with --rig", options.truth.string())};
  const Pose T_truth_map = align_path(association.pairs, oriented ? kPathLever_m : 0);
  EvaluationReport report = measure_path(association, T_truth_map, oriented);
  report.estimate_poses = estimate->poses.size();
  report.truth_poses = truth->poses.size();
  report.poses = pose_errors(association.pairs, T_truth_map, oriented);
  if (oriented)
    if (const Status added = add_consistency(report, options, association.pairs); !added.ok()) return added.error();
  const RigTime begin = association.pairs.front().stamp;
  if (const Status added = add_innovations(report, options, begin); !added.ok()) return added.error();
  const Pose T_truth_mesh = align_path(association.pairs, oriented ? kMeshLever_m : 0);
  if (const Status added = add_mesh(report, options, association.pairs, T_truth_mesh); !added.ok())
    return added.error();
  return report;
}

}  // namespace lxd
