// SPDX-License-Identifier: Apache-2.0
// What a layer is as a whole, and which slope of a quad is believed: a flat layer's noise is not, a step of its own is.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include "mapping/layer.hpp"

namespace lxd::mapping_layer_test {
namespace {

constexpr float kSpacing_m = 0.08F, kInverse = 1 / kSpacing_m;
constexpr std::uint32_t kAllSeen = (1U << kLayerQuads) - 1;

// Heights slope_u u + slope_v v + noise, known to `sigma_m`.
Layer tilted(float slope_u, float slope_v, float noise_m, float sigma_m, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<float> noise(0, 1);
  Layer layer{};
  for (int i = 0; i < kLayerVertices; ++i) {
    const auto u = static_cast<float>(i % kVerticesPerEdge), v = static_cast<float>(i / kVerticesPerEdge);
    layer.height_m[i] = kSpacing_m * (slope_u * u + slope_v * v) + noise_m * noise(random);
    layer.variance_m2[i] = sigma_m * sigma_m;
  }
  layer.seen_quads = kAllSeen;
  update_means(layer, kInverse);
  return layer;
}

LayerDistance above_quad(const Layer& layer, int quad) {
  Eigen::Vector3f p(0, 0, 1);
  p[axis_u(layer.axis)] = (static_cast<float>(quad % kQuadsPerEdge) + 0.5F) * kSpacing_m;
  p[axis_v(layer.axis)] = (static_cast<float>(quad / kQuadsPerEdge) + 0.5F) * kSpacing_m;
  return distance_to(layer, p, kInverse);
}

Eigen::Vector3f normal_of(float slope_u, float slope_v) {
  Eigen::Vector3f n;
  n[2] = 1;
  n[axis_u(2)] = -slope_u;
  n[axis_v(2)] = -slope_v;
  return n.normalized();
}

TEST(MappingLayer, MeansAreThoseOfATiltedPlane) {
  const Layer layer = tilted(0.3F, -0.2F, 0, 0.01F);
  EXPECT_NEAR(layer.mean_slope_u, 0.3F, 1e-5F);
  EXPECT_NEAR(layer.mean_slope_v, -0.2F, 1e-5F);
  EXPECT_NEAR(layer.mean_variance_m2, 1e-4F, 1e-9F);
}

TEST(MappingLayer, OnlySeenQuadsCount) {
  Layer layer = tilted(0.3F, -0.2F, 0, 0.01F);
  for (int v = 0; v < kVerticesPerEdge; ++v) {
    layer.height_m[v * kVerticesPerEdge + kQuadsPerEdge] = 9;  // the far column of vertices
    layer.variance_m2[v * kVerticesPerEdge + kQuadsPerEdge] = 9;
  }
  for (int v = 0; v < kQuadsPerEdge; ++v) layer.seen_quads &= ~(1U << (v * kQuadsPerEdge + kQuadsPerEdge - 1));
  update_means(layer, kInverse);
  EXPECT_NEAR(layer.mean_slope_u, 0.3F, 1e-5F);
  EXPECT_NEAR(layer.mean_slope_v, -0.2F, 1e-5F);
  EXPECT_NEAR(layer.mean_variance_m2, 1e-4F, 1e-9F);
  layer.seen_quads = 0;
  update_means(layer, kInverse);
  EXPECT_EQ(layer.mean_slope_u, 0);
  EXPECT_EQ(layer.mean_variance_m2, 0);
}

TEST(MappingLayer, ASlopeIsBelievedAsFarAsItsDoubtDoesNotExplainIt) {
  constexpr float kMean = 0.1F, kVariance = 0.04F;
  EXPECT_EQ(believed_slope(kMean, kMean, kVariance), kMean);
  EXPECT_NEAR(believed_slope(kMean + 0.2F, kMean, kVariance), kMean + 0.1F, 1e-6F);  // as much as the doubt: half
  EXPECT_NEAR(believed_slope(kMean - 0.2F, kMean, kVariance), kMean - 0.1F, 1e-6F);
  EXPECT_NEAR(believed_slope(kMean + 2, kMean, kVariance), kMean + 2, 0.021F);  // ten times: all but a hundredth
  EXPECT_NEAR(believed_slope(kMean + 0.02F, kMean, kVariance), kMean, 0.0002F);
  EXPECT_NEAR(believed_slope(kMean + 0.5F, kMean, 0), kMean + 0.5F, 1e-6F);  // without doubt, all
  float last = -10;
  for (float local = -3; local < 3; local += 0.01F) {
    const float now = believed_slope(local, kMean, kVariance);
    EXPECT_GT(now, last);  // grows with what was measured
    last = now;
  }
}

// Given a flat layer whose vertices scatter as much as they are said to; then its quads have the layer's slope and not
// their own.
TEST(MappingLayer, NoiseOfAFlatLayerDoesNotTurnItsNormals) {
  double own = 0, believed = 0;
  int count = 0;
  for (unsigned seed = 0; seed < 50; ++seed) {
    const Layer layer = tilted(0.2F, -0.1F, 0.004F, 0.004F, seed);
    for (int quad = 0; quad < kLayerQuads; ++quad, ++count) {
      const int i = quad / kQuadsPerEdge * kVerticesPerEdge + quad % kQuadsPerEdge;
      const float slope = (layer.height_m[i + 1] - layer.height_m[i] + layer.height_m[i + kVerticesPerEdge + 1] -
                           layer.height_m[i + kVerticesPerEdge]) *
                          kInverse / 2;
      own += (slope - 0.2) * (slope - 0.2);
      const Eigen::Vector3f n = above_quad(layer, quad).normal;
      const double found = -n[axis_u(2)] / n[2];
      believed += (found - 0.2) * (found - 0.2);
    }
  }
  EXPECT_GT(std::sqrt(own / count), 0.04);
  EXPECT_LT(std::sqrt(believed / count), 0.6 * std::sqrt(own / count));
}

TEST(MappingLayer, ARealStepKeepsItsOwnSlope) {
  // Given a floor with a step of 8 cm in its third column of quads, known to 4 mm ...
  Layer layer = tilted(0, 0, 0, 0.004F);
  for (int i = 0; i < kLayerVertices; ++i)
    if (i % kVerticesPerEdge > 2) layer.height_m[i] = 0.08F;
  update_means(layer, kInverse);
  EXPECT_NEAR(layer.mean_slope_u, 0.2F, 1e-5F);
  // ... then the step is as steep as it is, and the floor on both sides is flat.
  for (int v = 0; v < kQuadsPerEdge; ++v) {
    EXPECT_LT((above_quad(layer, v * kQuadsPerEdge + 2).normal - normal_of(1, 0)).norm(), 0.01F) << v;
    for (const int u : {0, 1, 3, 4})
      EXPECT_LT((above_quad(layer, v * kQuadsPerEdge + u).normal - normal_of(0, 0)).norm(), 0.03F) << u;
  }
}

TEST(MappingLayer, DistanceAndVarianceAreAlongTheBelievedNormal) {
  const Layer layer = tilted(0.75F, 0, 0, 0.001F);
  const LayerDistance found = above_quad(layer, 12);
  EXPECT_LT((found.normal - normal_of(0.75F, 0)).norm(), 1e-3F);
  EXPECT_NEAR(found.normal.norm(), 1, 1e-6F);
  EXPECT_NEAR(found.distance_m, 0.8F * (1 - 0.75F * 0.2F), 1e-4F);  // cos = 0.8
  EXPECT_NEAR(found.variance_m2, 0.64F * 1e-6F, 1e-9F);
}

}  // namespace
}  // namespace lxd::mapping_layer_test
