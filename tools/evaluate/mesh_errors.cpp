// SPDX-License-Identifier: Apache-2.0
// Accuracy and completeness of a mesh.
#include "tools/evaluate/mesh_errors.hpp"

#include <algorithm>
#include <array>

#include "tools/evaluate/triangle_grid.hpp"

namespace lxd {
namespace {

constexpr std::array<double, 3> kThresholds_m{0.02, 0.05, 0.10};

using Points = std::vector<Eigen::Vector3d>;

Points thinned(std::span<const Eigen::Vector3d> path_m, double spacing_m) {
  Points viewpoints;
  for (const Eigen::Vector3d& p : path_m)
    if (viewpoints.empty() || (p - viewpoints.back()).norm() >= spacing_m) viewpoints.push_back(p);
  return viewpoints;
}

// Neighbouring samples are mostly seen from the same place: it is tried first.
class Visibility {
 public:
  Visibility(const TriangleGrid& world, Points viewpoints, double range_m)
      : world_(world), viewpoints_(std::move(viewpoints)), range_m_(range_m) {}

  bool sees(const Eigen::Vector3d& p) {
    const auto seen_from = [&](const Eigen::Vector3d& eye) {
      return (p - eye).norm() <= range_m_ && !world_.hidden(eye, p);
    };
    const auto found = std::ranges::find_if(viewpoints_, seen_from);
    if (found == viewpoints_.end()) return false;
    std::iter_swap(viewpoints_.begin(), found);
    return true;
  }

 private:
  const TriangleGrid& world_;
  Points viewpoints_;
  double range_m_;
};

std::vector<double> distances(const Points& points, const TriangleGrid& surface, double reach_m) {
  std::vector<double> distances_m;
  distances_m.reserve(points.size());
  for (const Eigen::Vector3d& p : points) distances_m.push_back(surface.distance_m(p, reach_m));
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

}  // namespace

MeshErrors mesh_errors(const TriangleMesh& mesh, const TriangleMesh& world, std::span<const Eigen::Vector3d> path_m,
                       const MeshErrorOptions& options) {
  const TriangleGrid world_grid(world);
  const TriangleGrid mesh_grid(mesh);
  Points seen = sample_surface(world, options.samples);
  MeshErrors errors;
  errors.world_samples = seen.size();
  Visibility visibility(world_grid, thinned(path_m, options.viewpoint_spacing_m), options.view_range_m);
  std::erase_if(seen, [&](const Eigen::Vector3d& p) { return !visibility.sees(p); });
  errors.world_samples_counted = seen.size();

  const std::vector<double> accuracy_m = distances(sample_surface(mesh, options.samples), world_grid, options.reach_m);
  const std::vector<double> completeness_m = distances(seen, mesh_grid, options.reach_m);
  for (const double threshold_m : kThresholds_m)
    errors.scores.push_back(score(accuracy_m, completeness_m, threshold_m));
  errors.vertices = mesh.vertices_m.size();
  errors.faces = mesh.faces.size();
  errors.area_m2 = mesh.area_m2();
  errors.accuracy_m = summarise(accuracy_m);
  errors.completeness_m = summarise(completeness_m);
  return errors;
}

}  // namespace lxd
