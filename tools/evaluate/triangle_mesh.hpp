// SPDX-License-Identifier: Apache-2.0
// A triangle mesh in memory, as the evaluation needs it: read from PLY, moved, measured, sampled.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include <Eigen/Core>

#include "rt/pose.hpp"
#include "rt/result.hpp"

namespace lxd {

struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices_m;
  std::vector<std::array<std::uint32_t, 3>> faces;
  std::vector<double> variance_m2;  // of each vertex, along the normal; empty: not known
  std::vector<std::uint8_t> glass;  // of each face: 1 hides what is behind, yet returns nothing; empty: no face does

  [[nodiscard]] Eigen::Vector3d normal(std::size_t face) const;  // unit; zero of a face without area
  [[nodiscard]] double area_m2(std::size_t face) const;
  [[nodiscard]] double area_m2() const;
  void transform(const Pose& T);
};

// PLY, ascii or binary, with vertex x y z (and variance, m^2, where known) and face lists `vertex_indices` (or
// `vertex_index`) and `glass` (0 or 1) where there is some; polygons are cut into fans. Error: file, what was found and
// wanted (no faces, an index that names no vertex, truncated, not finite).
Result<TriangleMesh> load_mesh_ply(const std::filesystem::path& path);

struct MeshSample {
  Eigen::Vector3d p;
  std::uint32_t face;
  Eigen::Vector3d weights;  // barycentric, of the face's corners
};

// About `count` points spread evenly over the area, the same ones each time.
std::vector<MeshSample> sample_surface(const TriangleMesh& mesh, std::size_t count);

// Between those of the face's corners. Precondition: the mesh knows its variance.
double variance_m2(const TriangleMesh& mesh, const MeshSample& sample);

}  // namespace lxd
