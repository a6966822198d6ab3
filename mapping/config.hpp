// SPDX-License-Identifier: Apache-2.0
// Every number of the map that a user may set, with its default. One set serves every sensor and carrier.
#pragma once

namespace lxd {

struct MappingConfig {
  double cell_size_m = 0.5;      // r_cell of the paper: of the fine cells, which become the mesh
  double coarse_factor = 6.0;    // edge of the coarse cells, in fine ones
  double kernel_length_m = 0.5;  // 1/l of the paper's exponential kernel
  double surface_roughness_m =
      0.01;  // least standard deviation of a surface about its local plane: the kernel's amplitude
  double planarity_max_ratio = 30.0;  // tau_ns: waiting points with lambda_3 / lambda_2 above are a line, not a surface
  double layer_thickness_max_m = 0.015;  // scatter of the points about a new layer's plane beyond their noise, at most
  double layer_gate_sigmas = 3.0;        // a point joins a layer within this many standard deviations
  int layer_points_min = 8;              // points that make a new layer
  double independent_looks_max =
      20.0;  // fused variance is never below one look's divided by this: looks share pose errors
  double converged_sigma_m = 0.004;  // layers better than this take new points every refresh_interval-th sweep only
  int refresh_interval = 8;          // sweeps
  double mesh_sigma_max_m = 0.05;    // vertices worse than this are not exported
  double submesh_path_m = 40.0;      // way travelled after which a new sub-mesh begins
};

}  // namespace lxd
