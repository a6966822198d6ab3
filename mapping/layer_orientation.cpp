// SPDX-License-Identifier: Apache-2.0
#include "mapping/layer_orientation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

namespace lxd {
namespace {

// Of the normal's largest component:
constexpr float kServesShare = 0.6f;  // an axis that a layer may have for the sake of its neighbours
constexpr float kEqualShare = 0.8f;   // an axis that is as good as any

constexpr float kContinuesCosine = 0.95f;  // between the normals of a surface and its continuation next door
constexpr float kClearSine = 0.05f;        // of the angle between the plane and the way to the LiDAR

// The layer's plane by weighted least squares: height at the cell's centre, slopes along u and v.
Eigen::Vector3f plane_of(const Layer& layer, float cell_size_m) {
  const float spacing = cell_size_m / kQuadsPerEdge, half = 0.5f * cell_size_m;
  Eigen::Matrix3f A = Eigen::Matrix3f::Zero();
  Eigen::Vector3f c = Eigen::Vector3f::Zero();
  for (int i = 0; i < kLayerVertices; ++i) {
    const Eigen::Vector3f x(1.0f, spacing * static_cast<float>(i % kVerticesPerEdge) - half,
                            spacing * static_cast<float>(i / kVerticesPerEdge) - half);
    const float weight = 1.0f / layer.variance_m2[i];
    A += weight * x * x.transpose();
    c += weight * layer.height_m[i] * x;
  }
  return A.llt().solve(c);
}

Eigen::Vector3f normal_of(const Layer& layer, float cell_size_m) {
  const Eigen::Vector3f plane = plane_of(layer, cell_size_m);
  Eigen::Vector3f normal;
  normal[layer.axis] = 1;
  normal[axis_u(layer.axis)] = -plane[1];
  normal[axis_v(layer.axis)] = -plane[2];
  return normal.normalized();
}

int largest_of(const Eigen::Array3f& size) {
  int axis = 0;
  size.maxCoeff(&axis);
  return axis;
}

using Votes = std::array<int, 3>;

void count_votes(const SubMesh& sub_mesh, const Cell& cell, const Eigen::Vector3f& normal, float cell_size_m,
                 Votes& votes) {
  for (std::uint32_t k = 0; k < cell.layer_count; ++k) {
    const Layer& layer = sub_mesh.layer(cell.layers[k]);
    if (std::abs(normal_of(layer, cell_size_m).dot(normal)) > kContinuesCosine) ++votes[layer.axis];
  }
}

Votes votes_around(const SubMesh& sub_mesh, const CellIndex& index, const Eigen::Vector3f& normal, float cell_size_m) {
  Votes votes{};
  for (int i = 0; i < 27; ++i) {
    const CellIndex step(i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1);
    const std::uint32_t found = step.isZero() ? kNone : sub_mesh.find(index + step);
    if (found != kNone) count_votes(sub_mesh, sub_mesh.cells()[found], normal, cell_size_m, votes);
  }
  return votes;
}

}  // namespace

int axis_for(const SubMesh& sub_mesh, const CellIndex& index, const Eigen::Vector3f& normal, float cell_size_m) {
  const Eigen::Array3f size = normal.cwiseAbs();
  const float largest = size.maxCoeff();
  if ((size < kServesShare * largest).count() == 2) return largest_of(size);
  const Votes votes = votes_around(sub_mesh, index, normal, cell_size_m);
  int best = 0;
  for (int axis = 1; axis < 3; ++axis)
    if (votes[axis] > votes[best]) best = axis;
  if (votes[best] > 0 && size[best] >= kServesShare * largest) return best;
  best = 0;
  while (size[best] < kEqualShare * largest) ++best;  // a rule that all cells of the surface follow: the first
  return best;
}

std::int8_t side_of(const Layer& layer, const Eigen::Vector3f& sensor_cell_m, float cell_size_m) {
  const Eigen::Vector3f plane = plane_of(layer, cell_size_m);
  const float half = 0.5f * cell_size_m;
  const float u = sensor_cell_m[axis_u(layer.axis)] - half, v = sensor_cell_m[axis_v(layer.axis)] - half;
  const float rise = sensor_cell_m[layer.axis] - plane[0], above = rise - plane[1] * u - plane[2] * v;
  const float clear =
      kClearSine * std::sqrt((u * u + v * v + rise * rise) * (1 + plane[1] * plane[1] + plane[2] * plane[2]));
  return std::abs(above) < clear ? layer.side : above > 0 ? std::int8_t{1} : std::int8_t{-1};
}

}  // namespace lxd
