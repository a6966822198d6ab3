// SPDX-License-Identifier: Apache-2.0
// Measures and samples of a triangle mesh.
#include "tools/evaluate/triangle_mesh.hpp"

#include <cmath>

#include <Eigen/Geometry>

namespace lxd {
namespace {

// The R2 low-discrepancy sequence (M. Roberts, 2018, built on the plastic number), folded into the triangle.
Eigen::Vector2d barycentric(std::size_t index) {
  constexpr double kA1 = 0.7548776662466927;
  constexpr double kA2 = 0.5698402909980532;
  const auto n = static_cast<double>(index);
  Eigen::Vector2d b(std::fmod(kA1 * n, 1.0), std::fmod(kA2 * n, 1.0));
  return b.sum() > 1 ? Eigen::Vector2d(1 - b.x(), 1 - b.y()) : b;
}

}  // namespace

Eigen::Vector3d TriangleMesh::normal(std::size_t face) const {
  const auto& [a, b, c] = faces[face];
  return (vertices_m[b] - vertices_m[a]).cross(vertices_m[c] - vertices_m[a]).stableNormalized();
}

double TriangleMesh::area_m2(std::size_t face) const {
  const auto& [a, b, c] = faces[face];
  return 0.5 * (vertices_m[b] - vertices_m[a]).cross(vertices_m[c] - vertices_m[a]).norm();
}

double TriangleMesh::area_m2() const {
  double area = 0;
  for (std::size_t face = 0; face < faces.size(); ++face) area += area_m2(face);
  return area;
}

void TriangleMesh::transform(const Pose& T) {
  for (Eigen::Vector3d& v : vertices_m) v = T * v;
}

std::vector<MeshSample> sample_surface(const TriangleMesh& mesh, std::size_t count) {
  std::vector<MeshSample> samples;
  const double step_m2 = mesh.area_m2() / static_cast<double>(count);
  if (!(step_m2 > 0)) return samples;
  double due_m2 = 0.5 * step_m2;  // area until the next sample
  for (std::size_t face = 0; face < mesh.faces.size(); ++face) {
    const auto& [a, b, c] = mesh.faces[face];
    const double area = mesh.area_m2(face);
    for (; due_m2 < area; due_m2 += step_m2) {
      const Eigen::Vector2d at = barycentric(samples.size());
      samples.push_back({mesh.vertices_m[a] + at.x() * (mesh.vertices_m[b] - mesh.vertices_m[a]) +
                             at.y() * (mesh.vertices_m[c] - mesh.vertices_m[a]),
                         static_cast<std::uint32_t>(face),
                         {1 - at.x() - at.y(), at.x(), at.y()}});
    }
    due_m2 -= area;
  }
  return samples;
}

double variance_m2(const TriangleMesh& mesh, const MeshSample& sample) {
  double variance = 0;
  for (int corner = 0; corner < 3; ++corner)
    variance += sample.weights[corner] * mesh.variance_m2[mesh.faces[sample.face][corner]];
  return variance;
}

}  // namespace lxd
