// SPDX-License-Identifier: Apache-2.0
// The Gaussian process against a dense solution in double, and what its heights and variances are worth as statistics.
#include <cmath>
#include <random>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "mapping/batches.hpp"
#include "mapping/gaussian_process.hpp"

namespace lxd::mapping_gaussian_process_test {
namespace {

constexpr GpKernel kKernel{2.0F, 0.01F, 0.5F};
constexpr float kSpacing_m = kKernel.cell_size_m / kQuadsPerEdge;

struct Reference {
  Eigen::VectorXd mean, variance;
};

// Rasmussen & Williams eq. 2.25/2.26 with the plane as a further, linear kernel (eq. 2.40): x^T B x', B the prior of
// offset and slopes.
Reference dense_solution(const GpBatch& batch, double amplitude_m2) {
  const int n = batch.count;
  const double size = kKernel.cell_size_m, centre = size / 2;
  const Eigen::Vector3d B(size * size, 1, 1);
  const auto kernel = [&](double u, double v, double s, double t) {
    return amplitude_m2 * std::exp(-static_cast<double>(kKernel.inverse_length) * std::hypot(u - s, v - t)) +
           Eigen::Vector3d(1, u - centre, v - centre).dot(B.cwiseProduct(Eigen::Vector3d(1, s - centre, t - centre)));
  };
  Eigen::MatrixXd K(n, n), k(n, kLayerVertices);
  Eigen::VectorXd h(n), prior(kLayerVertices);
  for (int i = 0; i < n; ++i) {
    h[i] = batch.height_m[i];
    for (int j = 0; j < n; ++j) K(i, j) = kernel(batch.u_m[i], batch.v_m[i], batch.u_m[j], batch.v_m[j]);
    K(i, i) += static_cast<double>(batch.noise_m2[i]);
  }
  for (int j = 0; j < kLayerVertices; ++j) {
    const double spacing = kSpacing_m, u = spacing * (j % kVerticesPerEdge), v = spacing * (j / kVerticesPerEdge);
    prior[j] = kernel(u, v, u, v);
    for (int i = 0; i < n; ++i) k(i, j) = kernel(batch.u_m[i], batch.v_m[i], u, v);
  }
  const double mean = h.mean();
  const Eigen::LLT<Eigen::MatrixXd> llt(K);
  const Eigen::VectorXd heights = (k.transpose() * llt.solve((h.array() - mean).matrix())).array() + mean;
  return {heights, prior - (k.transpose() * llt.solve(k)).diagonal()};
}

GpBatch noisy_batch(int count, std::mt19937& random, float noise_m, float slope_u = 0.3F, float slope_v = -0.2F) {
  std::uniform_real_distribution<float> within(0, kKernel.cell_size_m);
  std::normal_distribution<float> unit(0, 1);
  GpBatch batch;
  batch.count = count;
  for (int i = 0; i < count; ++i) {
    batch.u_m[i] = within(random);
    batch.v_m[i] = within(random);
    batch.height_m[i] = 0.2F + slope_u * batch.u_m[i] + slope_v * batch.v_m[i] + noise_m * unit(random);
    batch.noise_m2[i] = noise_m * noise_m;
  }
  return batch;
}

// Tolerance: float against double, 0.05 mm of height and 0.2 % of variance.
TEST(GaussianProcess, AgreesWithTheDenseSolution) {
  std::mt19937 random(3);
  for (int count = 2; count <= kGpPointsMax; ++count)
    for (const float amplitude : {1e-4F, 1e-2F}) {
      const GpBatch batch = noisy_batch(count, random, 0.01F);
      GpPrediction out;
      regress(batch, kKernel, amplitude, out);
      const Reference reference = dense_solution(batch, static_cast<double>(amplitude));
      for (int i = 0; i < kLayerVertices; ++i) {
        ASSERT_NEAR(out.mean_m[i], reference.mean[i], 5e-5) << count << " points, vertex " << i;
        ASSERT_NEAR(out.variance_m2[i], reference.variance[i], 2e-3 * reference.variance[i])
            << count << " points, vertex " << i;
      }
    }
}

TEST(GaussianProcess, OnePointGivesItsHeightAndTheSlopePriorsVariance) {
  GpBatch batch;
  batch.count = 1;
  batch.u_m[0] = batch.v_m[0] = 0.1F;
  batch.height_m[0] = 0.3F;
  batch.noise_m2[0] = 1e-4F;
  GpPrediction out;
  regress(batch, kKernel, 1e-4F, out);
  EXPECT_NEAR(out.mean_m[kVerticesPerEdge + 1], 0.3F, 1e-4F);
  EXPECT_GT(out.variance_m2[kLayerVertices - 1], 0.04F);  // 0.57 m away with a slope of +-1
}

TEST(GaussianProcess, VarianceGrowsAwayFromTheData) {
  std::mt19937 random(4);
  GpBatch batch = noisy_batch(12, random, 0.01F);
  for (int i = 0; i < batch.count; ++i) {
    batch.u_m[i] *= 0.3F;  // all in one corner
    batch.v_m[i] *= 0.3F;
  }
  GpPrediction out;
  regress(batch, kKernel, 1e-4F, out);
  for (int i = 2; i + 1 < kVerticesPerEdge; ++i) {  // along the diagonal, away from the corner
    const int here = i * (kVerticesPerEdge + 1);
    EXPECT_GT(out.variance_m2[here + kVerticesPerEdge + 1], out.variance_m2[here]);
  }
}

TEST(GaussianProcess, RecoversANoiseFreePlane) {
  std::mt19937 random(5);
  GpBatch batch = noisy_batch(20, random, 0);
  for (float& noise : batch.noise_m2) noise = 1e-8F;
  GpPrediction out;
  regress(batch, kKernel, 1e-4F, out);
  for (int i = 0; i < kLayerVertices; ++i) {
    const float u = kSpacing_m * static_cast<float>(i % kVerticesPerEdge),
                v = kSpacing_m * static_cast<float>(i / kVerticesPerEdge);
    EXPECT_NEAR(out.mean_m[i], 0.2F + 0.3F * u - 0.2F * v, 1e-3F);
  }
}

// Calibration: (error / sigma)^2 has mean 1 when the kernel's amplitude is that of the surface. Here the surface is a
// plane, and the amplitude all but 0; 500 batches, vertices of one batch count as one sample: 1 +- 5 sqrt(2 / 500).
TEST(GaussianProcess, VarianceIsThatOfTheErrors) {
  std::mt19937 random(6);
  constexpr int kBatches = 500;
  double sum = 0;
  for (int k = 0; k < kBatches; ++k) {
    const GpBatch batch = noisy_batch(15, random, 0.02F);
    GpPrediction out;
    regress(batch, kKernel, 1e-8F, out);
    for (int i = 0; i < kLayerVertices; ++i) {
      const float u = kSpacing_m * static_cast<float>(i % kVerticesPerEdge),
                  v = kSpacing_m * static_cast<float>(i / kVerticesPerEdge);
      const auto error = static_cast<double>(out.mean_m[i] - (0.2F + 0.3F * u - 0.2F * v));
      sum += error * error / out.variance_m2[i] / kLayerVertices;
    }
  }
  EXPECT_NEAR(sum / kBatches, 1.0, 5 * std::sqrt(2.0 / kBatches));
}

TEST(GaussianProcessAmplitude, IsTheScatterBeyondTheNoise) {
  std::mt19937 random(7);
  double sum = 0;
  for (int k = 0; k < 400; ++k) {
    GpBatch batch = noisy_batch(25, random, 0.05F);
    for (float& noise : batch.noise_m2) noise = 0.02F * 0.02F;  // told less than there is
    sum += static_cast<double>(amplitude_of(batch, kKernel));
  }
  EXPECT_NEAR(sum / 400, 0.05 * 0.05 - 0.02 * 0.02, 2e-4);
}

TEST(GaussianProcessAmplitude, IsAtLeastTheRoughness) {
  std::mt19937 random(8);
  EXPECT_FLOAT_EQ(amplitude_of(noisy_batch(20, random, 0), kKernel), 1e-4F);
  EXPECT_FLOAT_EQ(amplitude_of(noisy_batch(3, random, 1), kKernel), 1e-4F);  // three points are always on a plane
}

TEST(QuadBins, AveragesTheReturnsOfAQuad) {
  QuadBins bins;
  EXPECT_TRUE(bins.empty());
  for (const float h : {0.1F, 0.2F, 0.3F}) bins.add(0.05F + h / 10, 0.15F, h, 4e-4F, 1 / kSpacing_m);
  bins.add(-0.01F, 0.51F, 0.4F, 1e-4F, 1 / kSpacing_m);  // just outside: the border's quad
  EXPECT_EQ(bins.seen(), 1U << kQuadsPerEdge | 1U << (4 * kQuadsPerEdge));
  const GpBatch batch = bins.batch();
  ASSERT_EQ(batch.count, 2);
  EXPECT_FLOAT_EQ(batch.height_m[0], 0.2F);
  EXPECT_FLOAT_EQ(batch.u_m[0], 0.07F);
  EXPECT_FLOAT_EQ(batch.noise_m2[0], 4e-4F / 3);
}

// Returns of one quad share the beam's and the pose's errors: more than eight bring nothing more.
TEST(QuadBins, VarianceOfTheMeanHasAFloor) {
  for (const auto& [returns, divisor] : {std::pair{7, 7.0F}, {8, 8.0F}, {9, 8.0F}, {1000, 8.0F}}) {
    QuadBins bins;
    for (int i = 0; i < returns; ++i) bins.add(0.25F, 0.25F, 0.1F, 4e-4F, 1 / kSpacing_m);
    EXPECT_NEAR(bins.batch().noise_m2[0], 4e-4F / divisor, 1e-8F);
  }
}

}  // namespace
}  // namespace lxd::mapping_gaussian_process_test
