// SPDX-License-Identifier: Apache-2.0
// The points that one look brings to a layer, thinned by space: one mean point a lattice quad. Every return counts, and
// a near, dense patch weighs no more than a far, sparse one.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include <Eigen/Core>

#include "mapping/gaussian_process.hpp"
#include "mapping/lattice.hpp"

namespace lxd {

class QuadBins {
 public:
  // u, v, h: in the cell's frame, metres.
  void add(float u_m, float v_m, float h_m, float variance_m2, float inverse_spacing) {
    const int iu = std::clamp(static_cast<int>(u_m * inverse_spacing), 0, kQuadsPerEdge - 1);
    const int iv = std::clamp(static_cast<int>(v_m * inverse_spacing), 0, kQuadsPerEdge - 1);
    const int quad = iv * kQuadsPerEdge + iu;
    Bin& bin = bins_[quad];
    if ((seen_ >> quad & 1u) == 0) bin = {};
    seen_ |= 1u << quad;
    bin.u += u_m;
    bin.v += v_m;
    bin.h += h_m;
    bin.variance += variance_m2;
    bin.count += 1.0f;
  }

  [[nodiscard]] std::uint32_t seen() const { return seen_; }
  [[nodiscard]] bool empty() const { return seen_ == 0; }

  // Mean points with the variance of a mean. A bin's returns share the beam's and the pose's errors, so that more than
  // kIndependentMax of them bring nothing more.
  [[nodiscard]] GpBatch batch() const {
    GpBatch out;
    for (std::uint32_t rest = seen_; rest != 0; rest &= rest - 1) {
      const Bin& bin = bins_[std::countr_zero(rest)];
      const float inverse = 1.0f / bin.count;
      const int i = out.count++;
      out.u_m[i] = bin.u * inverse;
      out.v_m[i] = bin.v * inverse;
      out.height_m[i] = bin.h * inverse;
      out.noise_m2[i] = bin.variance * inverse / std::min(bin.count, kIndependentMax);
    }
    return out;
  }

 private:
  static constexpr float kIndependentMax = 8.0f;
  struct Bin {
    float u, v, h, variance, count;
  };
  std::array<Bin, kLayerQuads> bins_;  // valid where seen_ says so
  std::uint32_t seen_ = 0;
};

}  // namespace lxd
