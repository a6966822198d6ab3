// SPDX-License-Identifier: Apache-2.0
#include "mapping/plane_search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <Eigen/Eigenvalues>

#include "mapping/lattice.hpp"

namespace lxd {
namespace {

constexpr int kHypotheses = 12;         // triplets tried when the points are not of one surface
constexpr float kMemberSigmas = 2.0f;   // distance to a plane, in layer thicknesses, within which a point is of it
constexpr float kBreadthSigmas = 3.0f;  // second principal deviation of a surface, in deviations of the noise, at least
constexpr float kMemberShare =
    0.4f;  // of the points, that a plane among several must hold: foliage has planes by chance
constexpr float kTripletArea_m2 = 1e-3f;  // thinner triangles give no plane

struct Moments {
  Eigen::Vector3f mean;
  Eigen::Vector3f eigenvalues;  // lambda_1 <= lambda_2 <= lambda_3, m^2
  Eigen::Vector3f normal;
};

Moments principal_components(std::span<const Eigen::Vector3f> points, std::uint32_t members) {
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  const auto n = static_cast<float>(std::popcount(members));
  const Eigen::Vector3f origin = points[0];
  for (std::size_t i = 0; i < points.size(); ++i) {
    if ((members >> i & 1u) == 0) continue;
    const Eigen::Vector3f d = points[i] - origin;
    sum += d;
    squares += d * d.transpose();
  }
  const Eigen::Vector3f mean = sum / n;
  const Eigen::Matrix3f scatter = squares / n - mean * mean.transpose();
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver;  // float's has the C library's atan2f: not the same everywhere
  solver.computeDirect(scatter.cast<double>());
  return {origin + mean, solver.eigenvalues().cast<float>(), solver.eigenvectors().col(0).cast<float>()};
}

// The paper's planarity threshold, and a bound on the thickness: without it two walls of a corner pass for one surface.
// Its breadth must also stand out of the noise: a single scan line on a wall, widened by range noise, spans a plane
// through the LiDAR, and a map of such planes holds the LiDAR where it is.
bool is_surface(const Moments& m, const MappingConfig& config, float noise_m2) {
  const auto thickness = static_cast<float>(config.layer_thickness_max_m);
  return m.eigenvalues[1] > kBreadthSigmas * kBreadthSigmas * noise_m2 &&
         m.eigenvalues[2] <= static_cast<float>(config.planarity_max_ratio) * m.eigenvalues[1] &&
         m.eigenvalues[0] <= thickness * thickness + noise_m2 && m.eigenvalues[0] < 0.25f * m.eigenvalues[1];
}

std::uint32_t members_of(std::span<const Eigen::Vector3f> points, const Eigen::Vector3f& on_plane,
                         const Eigen::Vector3f& normal, float tolerance_m) {
  std::uint32_t members = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    members |= static_cast<std::uint32_t>(std::abs(normal.dot(points[i] - on_plane)) <= tolerance_m) << i;
  return members;
}

// The hypothesis with most members among planes through three of the points.
std::uint32_t best_triplet(std::span<const Eigen::Vector3f> points, float tolerance_m, std::uint64_t seed) {
  std::uint32_t best = 0;
  for (int k = 0; k < kHypotheses; ++k) {
    const std::uint64_t draw = scatter(seed + static_cast<std::uint64_t>(k));
    const auto drawn = [&](int shift) -> const Eigen::Vector3f& {
      return points[static_cast<std::size_t>((draw >> shift) % points.size())];
    };
    const auto& a = drawn(0);
    const auto& b = drawn(20);
    const auto& c = drawn(40);
    const Eigen::Vector3f cross = (b - a).cross(c - a);
    const float area = cross.norm();
    if (area < kTripletArea_m2) continue;
    const std::uint32_t members = members_of(points, a, cross / area, tolerance_m);
    if (std::popcount(members) > std::popcount(best)) best = members;
  }
  return best;
}

PlaneCandidate accept(std::span<const Eigen::Vector3f> points, std::uint32_t members, const MappingConfig& config,
                      float noise_m2) {
  if (std::popcount(members) < config.layer_points_min) return {};
  const Moments m = principal_components(points, members);
  if (!is_surface(m, config, noise_m2)) return {};
  return {true, m.mean, m.normal, members};
}

}  // namespace

PlaneCandidate search_plane(std::span<const Eigen::Vector3f> points, float noise_m2, const MappingConfig& config,
                            std::uint64_t seed) {
  const std::uint32_t all = points.size() == 32 ? ~0u : (1u << points.size()) - 1;
  PlaneCandidate candidate = accept(points, all, config, noise_m2);
  if (candidate.found) return candidate;
  const auto thickness = static_cast<float>(config.layer_thickness_max_m);
  const float tolerance = kMemberSigmas * std::sqrt(thickness * thickness + noise_m2);
  const std::uint32_t best = best_triplet(points, tolerance, seed);
  if (static_cast<float>(std::popcount(best)) < kMemberShare * static_cast<float>(points.size())) return {};
  return accept(points, best, config, noise_m2);
}

}  // namespace lxd
