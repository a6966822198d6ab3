// SPDX-License-Identifier: Apache-2.0
// Gaussian-process regression of one look at a surface: points of a cell in, heights and variances at its lattice
// vertices out (paper, "Continuous Surface Reconstruction via Gaussian Process Regression").
//
// The paper's kernel exp(-l |x - x'|) has unit amplitude, so its variance has no unit. Here the amplitude is a variance
// in m^2, and the mean is not zero but an unknown plane, integrated out (Rasmussen & Williams 2006, section 2.7). So a
// vertex far from every point is as uncertain as the plane's extrapolation, and no look pulls the surface anywhere.
#pragma once

#include <array>

#include "mapping/lattice.hpp"

namespace lxd {

inline constexpr int kGpPointsMax = kLayerQuads;  // training inputs: at most one mean point a quad

// Training data: u, v, h in the cell's frame, metres.
struct GpBatch {
  int count = 0;
  std::array<float, kGpPointsMax> u_m{}, v_m{}, height_m{};
  std::array<float, kGpPointsMax> noise_m2{};  // sigma_n^2 of each height
};

struct GpKernel {
  float inverse_length;   // l of the paper, 1/m
  float roughness_min_m;  // least amplitude; the batch's own scatter about its plane raises it
  float cell_size_m;
};

struct GpPrediction {
  std::array<float, kLayerVertices> mean_m;       // f*
  std::array<float, kLayerVertices> variance_m2;  // diagonal of Sigma*
};

// Variance of the surface about its plane for this batch: the scatter beyond the noise, at least the kernel's least.
float amplitude_of(const GpBatch& batch, const GpKernel& kernel);

// Precondition: 1 <= batch.count; noise_m2 > 0. No allocation; about 20 k multiplications for a full batch.
void regress(const GpBatch& batch, const GpKernel& kernel, float amplitude_m2, GpPrediction& out);

}  // namespace lxd
