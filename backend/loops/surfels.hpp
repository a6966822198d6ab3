// SPDX-License-Identifier: Apache-2.0
// A sub-mesh thinned for the loop search: one surface element a voxel and facing, in the sub-mesh's frame. What
// descriptors and registration are made of, so that neither walks over half a million vertices a key frame.
#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

#include "mapping/mesh.hpp"

namespace lxd {

struct Surfel {
  Eigen::Vector3f position_m;
  Eigen::Vector3f normal;    // unit, towards the side that the LiDAR saw
  float variance_m2 = 0;     // along the normal: the mean of its vertices', since their errors are shared
  float confidence_pm2 = 0;  // sum of 1 / (variance + epsilon) over its vertices (paper, D(r, theta)); 1/m^2
};

struct ThinningConfig {
  double voxel_m = 0.3;
  double variance_max_m2 = 0.0016;  // tau_var: vertices worse than 4 cm are not trusted
  double epsilon_m2 = 1e-5;         // about the variance of the best known surfaces
};

// Vertices of one voxel that face the same of six ways become one element. In order of voxel: the same vertices, in
// whatever order, give the same voxels. Vertices that are not finite or whose variance is negative are left out.
std::vector<Surfel> thin_surfels(std::span<const MeshVertex> vertices, const ThinningConfig& config);

// The same again, of surfels; for coarser ones.
std::vector<Surfel> thin_surfels(std::span<const Surfel> surfels, double voxel_m);

}  // namespace lxd
