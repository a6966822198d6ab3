// SPDX-License-Identifier: Apache-2.0
#include "mapping/gaussian_process.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace lxd {
namespace {

// Right-hand sides solved together: k(x, x*) of every vertex, the plane's three basis functions, the heights. All rows
// are contiguous, so that the compiler turns each row operation into full vectors.
constexpr int kBasis = 3;
constexpr int kBasisColumn = kLayerVertices;
constexpr int kHeightColumn = kBasisColumn + kBasis;
constexpr int kColumns = kHeightColumn + 1;
static_assert(kColumns % 8 == 0, "rows are whole AVX registers");
constexpr int kRowStride = (kGpPointsMax + 7) / 8 * 8;

// Prior of the plane's slope: layers are seen along their dominant axis, so slopes stay near or below one.
constexpr float kSlopeSigma = 1.0f;

using Row = std::array<float, kColumns>;

struct Workspace {
  alignas(32) std::array<std::array<float, kRowStride>, kGpPointsMax> K;  // upper triangle: U with U^T U = K + noise
  alignas(32) std::array<Row, kGpPointsMax> B;
};

// exp(x) for x <= 0, relative error below 3e-7; no branches, so it vectorises.
inline float exp_negative(float x) {
  const float t = std::max(x, -80.0f) * 1.44269504f;
  const float whole = std::floor(t);
  const float f = t - whole;
  const float p =
      1.0f + f * (0.69314718f +
                  f * (0.24022651f + f * (0.05550411f + f * (0.00961813f + f * (0.00133336f + f * 0.00015469f)))));
  return p * std::bit_cast<float>((static_cast<std::int32_t>(whole) + 127) << 23);
}

inline float correlation(float du, float dv, float inverse_length) {
  return exp_negative(-inverse_length * std::sqrt(du * du + dv * dv));
}

// K_NN + sigma_n^2 I, upper triangle.
void fill_training(const GpBatch& b, const GpKernel& k, float amplitude, Workspace& w) {
  for (int i = 0; i < b.count; ++i) {
    for (int j = 0; j < kGpPointsMax; ++j)
      w.K[i][j] = amplitude * correlation(b.u_m[i] - b.u_m[j], b.v_m[i] - b.v_m[j], k.inverse_length);
    w.K[i][i] += b.noise_m2[i];
  }
}

// K_N*, the plane's basis (1, u, v about the cell's centre) and the heights about their mean.
void fill_right_hand_sides(const GpBatch& b, const GpKernel& k, float amplitude, float mean_height, Workspace& w) {
  const float spacing = k.cell_size_m / kQuadsPerEdge, centre = 0.5f * k.cell_size_m;
  for (int i = 0; i < b.count; ++i) {
    Row& row = w.B[i];
    for (int n = 0; n < kLayerVertices; ++n) {
      const float u = spacing * static_cast<float>(n % kVerticesPerEdge);
      const float v = spacing * static_cast<float>(n / kVerticesPerEdge);
      row[n] = amplitude * correlation(b.u_m[i] - u, b.v_m[i] - v, k.inverse_length);
    }
    row[kBasisColumn] = 1.0f;
    row[kBasisColumn + 1] = b.u_m[i] - centre;
    row[kBasisColumn + 2] = b.v_m[i] - centre;
    row[kHeightColumn] = b.height_m[i] - mean_height;
  }
}

// Cholesky of K in place, row by row, and B <- U^-T B with it.
void factor_and_solve(int n, Workspace& w) {
  for (int k = 0; k < n; ++k) {
    const float inverse = 1.0f / std::sqrt(w.K[k][k]);
    for (float& x : w.K[k]) x *= inverse;
    for (float& x : w.B[k]) x *= inverse;
    for (int i = k + 1; i < n; ++i) {
      const float factor = w.K[k][i];
      for (int j = 0; j < kRowStride; ++j) w.K[i][j] -= factor * w.K[k][j];
      for (int j = 0; j < kColumns; ++j) w.B[i][j] -= factor * w.B[k][j];
    }
  }
}

struct Plane {
  Eigen::Vector3f beta;        // offset, slopes
  Eigen::Matrix3f covariance;  // of beta
};

// Generalised least squares with a weak prior (R&W eq. 2.41: beta-bar).
Plane fit_plane(int n, const GpKernel& k, const Workspace& w) {
  Eigen::Matrix3f A = Eigen::Vector3f(1.0f / (k.cell_size_m * k.cell_size_m), 1.0f / (kSlopeSigma * kSlopeSigma),
                                      1.0f / (kSlopeSigma * kSlopeSigma))
                          .asDiagonal();
  Eigen::Vector3f c = Eigen::Vector3f::Zero();
  for (int i = 0; i < n; ++i) {
    const Eigen::Map<const Eigen::Vector3f> basis(&w.B[i][kBasisColumn]);
    A += basis * basis.transpose();
    c += basis * w.B[i][kHeightColumn];
  }
  const Eigen::LLT<Eigen::Matrix3f> llt(A);
  return {llt.solve(c), llt.solve(Eigen::Matrix3f::Identity())};
}

}  // namespace

float amplitude_of(const GpBatch& b, const GpKernel& kernel) {
  const float least = kernel.roughness_min_m * kernel.roughness_min_m;
  if (b.count <= kBasis) return least;
  Eigen::Matrix3f A = 1e-6f * Eigen::Matrix3f::Identity();
  Eigen::Vector3f c = Eigen::Vector3f::Zero();
  float hh = 0, noise = 0;
  const float h0 = b.height_m[0];
  for (int i = 0; i < b.count; ++i) {
    const Eigen::Vector3f x(1.0f, b.u_m[i], b.v_m[i]);
    const float h = b.height_m[i] - h0;
    A += x * x.transpose();
    c += x * h;
    hh += h * h;
    noise += b.noise_m2[i];
  }
  const float squares = std::max(0.0f, hh - c.dot(A.ldlt().solve(c)));
  const auto n = static_cast<float>(b.count);
  return std::max(least, squares / (n - kBasis) - noise / n);
}

void regress(const GpBatch& b, const GpKernel& kernel, float amplitude_m2, GpPrediction& out) {
  Workspace w{};  // zero: rows are worked on in full registers, beyond the batch too
  float mean_height = 0;
  for (int i = 0; i < b.count; ++i) mean_height += b.height_m[i];
  mean_height /= static_cast<float>(b.count);

  fill_training(b, kernel, amplitude_m2, w);
  fill_right_hand_sides(b, kernel, amplitude_m2, mean_height, w);
  factor_and_solve(b.count, w);
  const Plane plane = fit_plane(b.count, kernel, w);

  // f* and diag(Sigma*): the plane, plus the kernel's correction; R* of R&W eq. 2.42 carries the plane's uncertainty.
  alignas(32) Row mean{}, squares{}, r0{}, r1{}, r2{};
  for (int i = 0; i < b.count; ++i) {
    const Row& x = w.B[i];
    const float h0 = x[kBasisColumn], h1 = x[kBasisColumn + 1], h2 = x[kBasisColumn + 2];
    const float z = x[kHeightColumn] - h0 * plane.beta[0] - h1 * plane.beta[1] - h2 * plane.beta[2];
    for (int n = 0; n < kColumns; ++n) {
      mean[n] += x[n] * z;
      squares[n] += x[n] * x[n];
      r0[n] += x[n] * h0;
      r1[n] += x[n] * h1;
      r2[n] += x[n] * h2;
    }
  }
  const float spacing = kernel.cell_size_m / kQuadsPerEdge, centre = 0.5f * kernel.cell_size_m;
  for (int n = 0; n < kLayerVertices; ++n) {
    const Eigen::Vector3f x(1.0f, spacing * static_cast<float>(n % kVerticesPerEdge) - centre,
                            spacing * static_cast<float>(n / kVerticesPerEdge) - centre);
    const Eigen::Vector3f R = x - Eigen::Vector3f(r0[n], r1[n], r2[n]);
    out.mean_m[n] = mean_height + x.dot(plane.beta) + mean[n];
    out.variance_m2[n] = std::max(0.0f, amplitude_m2 - squares[n]) + R.dot(plane.covariance * R);
  }
}

}  // namespace lxd
