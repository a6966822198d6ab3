// SPDX-License-Identifier: Apache-2.0
// One Gaussian-process surface layer of a cell: heights and variances at the cell's lattice vertices, seen along an
// axis.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include <Eigen/Core>

#include "mapping/lattice.hpp"

namespace lxd {

struct Layer {
  std::array<float, kLayerVertices>
      height_m;  // mu, along `axis` from the cell's lower corner; index v * kVerticesPerEdge + u
  std::array<float, kLayerVertices> variance_m2;  // sigma^2 of the height
  std::uint32_t cell = kNone;
  std::uint32_t seen_quads = 0;  // bit v * kQuadsPerEdge + u: some return fell on that quad
  std::uint8_t axis = 2;         // 0 x, 1 y, 2 z
  std::int8_t side = 1;          // +1 or -1: on which side along `axis` the LiDAR was
  // Over the seen quads:
  float mean_variance_m2 = 0;                // of their vertices: how well the layer is known
  float mean_slope_u = 0, mean_slope_v = 0;  // of the surface
};

// What the layer is as a whole.
inline void update_means(Layer& layer, float inverse_spacing) {
  float sum = 0, count = 0, rise_u = 0, rise_v = 0;
  for (int q = 0; q < kLayerQuads; ++q) {
    if ((layer.seen_quads >> q & 1u) == 0) continue;
    const int i = q / kQuadsPerEdge * kVerticesPerEdge + q % kQuadsPerEdge;
    sum += layer.variance_m2[i] + layer.variance_m2[i + 1] + layer.variance_m2[i + kVerticesPerEdge] +
           layer.variance_m2[i + kVerticesPerEdge + 1];
    const auto& h = layer.height_m;
    rise_u += h[i + 1] - h[i] + h[i + kVerticesPerEdge + 1] - h[i + kVerticesPerEdge];
    rise_v += h[i + kVerticesPerEdge] - h[i] + h[i + kVerticesPerEdge + 1] - h[i + 1];
    count += 4.0f;
  }
  const float share = count > 0 ? 1.0f / count : 0.0f;
  layer.mean_variance_m2 = share * sum;
  layer.mean_slope_u = 2 * share * inverse_spacing * rise_u;
  layer.mean_slope_v = 2 * share * inverse_spacing * rise_v;
}

// The surface above or below a point of the cell.
struct SurfaceSample {
  float height_m;
  float slope_u, slope_v;
  float variance_m2;
};

// Bilinear between the four vertices around (u, v); p in the cell's frame, metres. Outside of the cell the border
// quad's surface continues, for which the caller answers.
inline SurfaceSample sample(const Layer& layer, float u_m, float v_m, float inverse_spacing) {
  const float fu = u_m * inverse_spacing, fv = v_m * inverse_spacing;
  const int iu = std::clamp(static_cast<int>(fu), 0, kQuadsPerEdge - 1);
  const int iv = std::clamp(static_cast<int>(fv), 0, kQuadsPerEdge - 1);
  const float a = fu - static_cast<float>(iu), b = fv - static_cast<float>(iv);
  const int i = iv * kVerticesPerEdge + iu;
  const auto& h = layer.height_m;
  const float h00 = h[i], h10 = h[i + 1], h01 = h[i + kVerticesPerEdge], h11 = h[i + kVerticesPerEdge + 1];
  const auto& s = layer.variance_m2;
  const float ac = std::clamp(a, 0.0f, 1.0f), bc = std::clamp(b, 0.0f, 1.0f);
  return {(1 - b) * ((1 - a) * h00 + a * h10) + b * ((1 - a) * h01 + a * h11),
          ((1 - b) * (h10 - h00) + b * (h11 - h01)) * inverse_spacing,
          ((1 - a) * (h01 - h00) + a * (h11 - h10)) * inverse_spacing,
          (1 - bc) * ((1 - ac) * s[i] + ac * s[i + 1]) +
              bc * ((1 - ac) * s[i + kVerticesPerEdge] + ac * s[i + kVerticesPerEdge + 1])};
}

// Signed orthogonal distance of a point to the layer's tangent plane below it; positive on the side of +axis.
struct LayerDistance {
  float distance_m;
  float variance_m2;       // of the surface, along its normal
  Eigen::Vector3f normal;  // unit, towards +axis
};

// A quad's slope, as far as it differs from the layer's by more than its vertices' doubt explains.
inline float believed_slope(float local, float mean, float slope_variance) {
  const float difference = local - mean, square = difference * difference;
  return mean + difference * (square / (square + slope_variance + 1e-12f));
}

inline LayerDistance distance_to(const Layer& layer, const Eigen::Vector3f& p_cell_m, float inverse_spacing) {
  const int axis = layer.axis, u = axis_u(axis), v = axis_v(axis);
  const SurfaceSample s = sample(layer, p_cell_m[u], p_cell_m[v], inverse_spacing);
  const float slope_variance = 2 * s.variance_m2 * inverse_spacing * inverse_spacing;
  const float slope_u = believed_slope(s.slope_u, layer.mean_slope_u, slope_variance);
  const float slope_v = believed_slope(s.slope_v, layer.mean_slope_v, slope_variance);
  const float cosine = 1.0f / std::sqrt(1.0f + slope_u * slope_u + slope_v * slope_v);
  LayerDistance out;
  out.distance_m = (p_cell_m[axis] - s.height_m) * cosine;
  out.variance_m2 = s.variance_m2 * cosine * cosine;
  out.normal[axis] = cosine;
  out.normal[u] = -slope_u * cosine;
  out.normal[v] = -slope_v * cosine;
  return out;
}

}  // namespace lxd
