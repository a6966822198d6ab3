// SPDX-License-Identifier: Apache-2.0
#include "backend/colour/gains.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>

#include "backend/colour/srgb.hpp"

namespace lxd {
namespace {

constexpr int kIterationsMax = 12;
constexpr double kSettled = 1e-3;
constexpr std::size_t kGainVerticesMax = 40'000;  // that gains are told from
// Levels whose logarithm says something: neither noise nor nearly full.
constexpr std::uint8_t kDarkest = 12, kBrightest = 248;
constexpr double kHuber = 0.03;
// What two images that share surfaces say of their ratio is worth one per cent, however many vertices it is of: they
// share a response curve and its errors.
constexpr double kPairSigma = 0.01, kPairVertices = 30;
// No image is far from what the camera made of it: a way from a cellar into the sun would be black or white else. A
// difference dies away over kGainSigma / kPairSigma images.
constexpr double kGainSigma = 0.7;
constexpr double kExposureSigma = 0.05, kHeldSigma = 1e-3, kFalloffSigma = 0.3, kKnownFalloffSigma = 0.03;

double squared_radius(const ColourSample& sample) {
  const double radius = sample.radius / 255.0;
  return radius * radius;
}

bool tells(const ColourSample& sample) {
  return std::ranges::all_of(sample.rgb, [](std::uint8_t level) { return level >= kDarkest && level <= kBrightest; });
}

// Sums over the vertices that two images share; the ratio is of the one with the lower number to the other.
struct PairSums {
  Eigen::Array3d weight = Eigen::Array3d::Zero(), ratio = weight, farther = weight, farther2 = weight,
                 farther_ratio = weight;
};

class GainProblem {
 public:
  GainProblem(const ColourSamples& samples, std::span<ImageGain> images, LensFalloff& falloff)
      : samples_(samples), images_(images), falloff_(falloff), prior_(falloff), pairs_(images.size() * images.size()) {
    stride_ = samples.vertices() / kGainVerticesMax + 1;
    for (std::size_t level = 1; level < log_.size(); ++level)
      log_[level] = std::log(static_cast<double>(light_of(static_cast<std::uint8_t>(level))));
  }

  void solve() {
    for (int i = 0; i < kIterationsMax; ++i) {
      std::ranges::fill(pairs_, PairSums{});
      for (std::size_t vertex = 0; vertex < samples_.vertices(); vertex += stride_) add(samples_.of(vertex));
      double moved = 0;
      for (int channel = 0; channel < 3; ++channel) moved = std::max(moved, step(channel));
      if (moved < kSettled) return;
    }
  }

 private:
  void add(std::span<const ColourSample> seen) {
    for (std::size_t i = 1; i < seen.size(); ++i)
      for (std::size_t k = 0; k < i; ++k)
        if (tells(seen[i]) && tells(seen[k]))
          seen[i].image < seen[k].image ? add(seen[i], seen[k]) : add(seen[k], seen[i]);
  }

  void add(const ColourSample& a, const ColourSample& b) {
    PairSums& sums = pairs_[a.image * images_.size() + b.image];
    const double farther = squared_radius(a) - squared_radius(b);
    for (int c = 0; c < 3; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      const double ratio = log_[a.rgb[channel]] - log_[b.rgb[channel]];
      const double left =
          ratio + images_[a.image].log_gain[c] - images_[b.image].log_gain[c] + falloff_.log_loss[c] * farther;
      const double weight = std::min(1.0, kHuber / std::max(std::abs(left), 1e-9));
      sums.weight[c] += weight;
      sums.ratio[c] += weight * ratio;
      sums.farther[c] += weight * farther;
      sums.farther2[c] += weight * farther * farther;
      sums.farther_ratio[c] += weight * farther * ratio;
    }
  }

  // Of gain a - gain b + falloff farther = -ratio.
  void add_pair(Eigen::Index a, Eigen::Index b, const PairSums& sums, int c) {
    const double weight = sums.weight[c];
    if (!(weight > 0)) return;
    const double scale = std::min(1.0, weight / kPairVertices) / (weight * kPairSigma * kPairSigma);
    const Eigen::Index last = N_.rows() - 1;
    add_difference(a, b, scale * weight, -scale * sums.ratio[c]);
    N_(a, last) += scale * sums.farther[c];
    N_(b, last) -= scale * sums.farther[c];
    N_(last, a) += scale * sums.farther[c];
    N_(last, b) -= scale * sums.farther[c];
    N_(last, last) += scale * sums.farther2[c];
    rhs_[last] -= scale * sums.farther_ratio[c];
  }

  void add_difference(Eigen::Index a, Eigen::Index b, double weight, double weighted_value) {
    N_(a, a) += weight;
    N_(b, b) += weight;
    N_(a, b) -= weight;
    N_(b, a) -= weight;
    rhs_[a] += weighted_value;
    rhs_[b] -= weighted_value;
  }

  void add_prior(Eigen::Index i, double value, double sigma) {
    N_(i, i) += 1 / (sigma * sigma);
    rhs_[i] += value / (sigma * sigma);
  }

  // One channel's gains and falloff by the sums; how far the farthest moved.
  double step(int channel) {
    const auto count = static_cast<Eigen::Index>(images_.size());
    N_.setZero(count + 1, count + 1);
    rhs_.setZero(count + 1);
    for (Eigen::Index a = 0; a < count; ++a)
      for (Eigen::Index b = a + 1; b < count; ++b)
        add_pair(a, b, pairs_[static_cast<std::size_t>(a * count + b)], channel);
    for (Eigen::Index i = 0; i < count; ++i) {
      const ImageGain& image = images_[static_cast<std::size_t>(i)];
      add_prior(i, image.settled ? image.log_gain[channel] : 0, image.settled ? kHeldSigma : kGainSigma);
      if (i > 0) add_exposures(i - 1, i);
    }
    add_prior(count, prior_.log_loss[channel], prior_.known ? kKnownFalloffSigma : kFalloffSigma);
    const Eigen::VectorXd solution = N_.ldlt().solve(rhs_);
    if (!solution.allFinite()) return 0;
    double moved = std::abs(solution[count] - falloff_.log_loss[channel]);
    falloff_.log_loss[channel] = solution[count];
    for (Eigen::Index i = 0; i < count; ++i) {
      double& gain = images_[static_cast<std::size_t>(i)].log_gain[channel];
      moved = std::max(moved, std::abs(solution[i] - gain));
      gain = solution[i];
    }
    return moved;
  }

  void add_exposures(Eigen::Index a, Eigen::Index b) {
    const auto &first = images_[static_cast<std::size_t>(a)].log_exposure,
               &second = images_[static_cast<std::size_t>(b)].log_exposure;
    constexpr double kWeight = 1 / (kExposureSigma * kExposureSigma);
    if (first && second) add_difference(a, b, kWeight, kWeight * (*second - *first));
  }

  const ColourSamples& samples_;
  std::span<ImageGain> images_;
  LensFalloff& falloff_;
  LensFalloff prior_;
  std::vector<PairSums> pairs_;
  std::size_t stride_ = 1;
  std::array<double, 256> log_{};
  Eigen::MatrixXd N_;
  Eigen::VectorXd rhs_;
};

}  // namespace

void settle_gains(const ColourSamples& samples, std::span<ImageGain> images, LensFalloff& falloff) {
  if (images.empty()) return;
  GainProblem(samples, images, falloff).solve();
  falloff.known = true;
  for (ImageGain& image : images) image.settled = true;
}

Eigen::Array3f compensation(const ColourSample& sample, const ImageGain& gain, const LensFalloff& falloff) {
  return (gain.log_gain + squared_radius(sample) * falloff.log_loss).exp().cast<float>();
}

}  // namespace lxd
