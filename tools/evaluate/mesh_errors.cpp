// SPDX-License-Identifier: Apache-2.0
// Accuracy and completeness of a mesh.
#include "tools/evaluate/mesh_errors.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/evaluate/calibration.hpp"
#include "tools/evaluate/triangle_grid.hpp"

namespace lxd {
namespace {

constexpr std::array<double, 3> kThresholds_m{0.02, 0.05, 0.10};

std::vector<double> distances(const std::vector<MeshSample>& samples, const TriangleGrid& surface, double reach_m) {
  std::vector<double> distances_m;
  distances_m.reserve(samples.size());
  for (const MeshSample& sample : samples) distances_m.push_back(surface.distance_m(sample.p, reach_m));
  return distances_m;
}

double share_within(const std::vector<double>& distances_m, double threshold_m) {
  if (distances_m.empty()) return 0;
  const auto within = std::ranges::count_if(distances_m, [=](double d) { return d <= threshold_m; });
  return static_cast<double>(within) / static_cast<double>(distances_m.size());
}

ThresholdScore score(const std::vector<double>& accuracy_m, const std::vector<double>& completeness_m,
                     double threshold_m) {
  ThresholdScore s{threshold_m, share_within(accuracy_m, threshold_m), share_within(completeness_m, threshold_m), 0};
  if (s.precision + s.recall > 0) s.f_score = 2 * s.precision * s.recall / (s.precision + s.recall);
  return s;
}

std::vector<MeshSample> samples_in_view(const TriangleMesh& world, const TriangleGrid& grid, std::span<const Pose> path,
                                        const MeshErrorOptions& options, std::size_t& all) {
  std::vector<MeshSample> samples = sample_surface(world, options.samples);
  all = samples.size();
  LidarView everywhere;
  everywhere.range_m = {0, options.view_range_m};
  const std::span<const LidarView> lidars =
      options.lidars.empty() ? std::span<const LidarView>(&everywhere, 1) : std::span<const LidarView>(options.lidars);
  WorldSight visibility(grid, path, lidars, options.viewpoint_spacing_m, options.viewpoint_turn_rad);
  const auto unseen = [&](const MeshSample& s) {
    const bool glass = !world.glass.empty() && world.glass[s.face] != 0;
    return glass || !visibility.sees(s.p, world.normal(s.face));
  };
  std::erase_if(samples, unseen);
  return samples;
}

MeshCalibration calibration_of(const TriangleMesh& mesh, const std::vector<MeshSample>& samples,
                               const std::vector<double>& errors_m, double reach_m) {
  std::vector<ClaimedError> errors;
  errors.reserve(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i)
    errors.push_back({errors_m[i], std::sqrt(variance_m2(mesh, samples[i]))});
  return calibration(std::move(errors), reach_m);
}

}  // namespace

MeshErrors mesh_errors(const TriangleMesh& mesh, const TriangleMesh& world, std::span<const Pose> path,
                       const MeshErrorOptions& options) {
  const TriangleGrid world_grid(world);
  const TriangleGrid mesh_grid(mesh);
  MeshErrors errors;
  const auto seen = samples_in_view(world, world_grid, path, options, errors.world_samples);
  errors.world_samples_counted = seen.size();

  const auto samples = sample_surface(mesh, options.samples);
  errors.distances_m = distances(samples, world_grid, options.reach_m);
  const std::vector<double> completeness_m = distances(seen, mesh_grid, options.reach_m);
  for (const double threshold_m : kThresholds_m)
    errors.scores.push_back(score(errors.distances_m, completeness_m, threshold_m));
  errors.vertices = mesh.vertices_m.size();
  errors.faces = mesh.faces.size();
  errors.area_m2 = mesh.area_m2();
  errors.accuracy_m = summarise(errors.distances_m);
  errors.completeness_m = summarise(completeness_m);
  if (!mesh.variance_m2.empty())
    errors.calibration = calibration_of(mesh, samples, errors.distances_m, options.reach_m);
  return errors;
}

}  // namespace lxd
