// SPDX-License-Identifier: Apache-2.0
#include "estimator/vision/turn_guess.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "estimator/normal_equations.hpp"
#include "rt/so3.hpp"

namespace lxd {
namespace {

constexpr std::uint32_t kFeaturesMin = 8;
constexpr int kIterations = 12;
constexpr double kMedianToSigma = 0.8493;  // of the length of a vector of two normal errors: 1 / sqrt(2 ln 2)
constexpr double kConverged_rad = 1e-9;

struct BearingPair {
  Eigen::Vector3d before, now;
};

struct Pairs {
  std::array<BearingPair, kFeaturesMax> storage;
  std::array<double, kFeaturesMax> scratch;
  std::uint32_t count = 0;

  [[nodiscard]] std::span<const BearingPair> all() const { return std::span(storage).first(count); }

  // 1.48 medians of one axis' error, at least the bearings' noise.
  double scale(const Eigen::Matrix3d& R, double least) {
    for (std::uint32_t i = 0; i < count; ++i) scratch[i] = (R * storage[i].before - storage[i].now).norm();
    const auto middle = scratch.begin() + count / 2;
    std::nth_element(scratch.begin(), middle, scratch.begin() + count);
    return std::max(least, kMedianToSigma * *middle);
  }
};

// Both frames have their features in the order of their birth.
void match(const FeatureFrame& before, const FeatureFrame& now, Pairs& pairs) {
  const auto old = before.features();
  auto cursor = old.begin();
  for (const Feature& feature : now.features()) {
    const auto same = [&](const Feature& other) { return other.id == feature.id; };
    const auto at = std::find_if(cursor, old.end(), same);
    if (at == old.end()) continue;
    cursor = at + 1;
    pairs.storage[pairs.count] = {at->direction(), feature.direction()};
    pairs.count += pairs.storage[pairs.count].before.allFinite() && pairs.storage[pairs.count].now.allFinite();
  }
}

}  // namespace

// e = R a - b and R <- R Exp(dtheta): H = -R a^, so that H^T H = I - a a^T and -H^T e = a x (R^T b).
bool guess_turn(const FeatureFrame& before, const FeatureFrame& now, const Eigen::Matrix3d& R_expected,
                double sigma_rad, TurnGuess& guess) noexcept {
  Pairs pairs;
  match(before, now, pairs);
  guess = {R_expected, Eigen::Matrix3d::Zero(), pairs.count, 0};
  if (pairs.count < kFeaturesMin) return false;
  for (int i = 0; i < kIterations; ++i) {
    const double scale = pairs.scale(guess.R_now_before, sigma_rad), k = kernel_sigmas(i);
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d pull = Eigen::Vector3d::Zero();
    double weight = 0;
    for (const auto& [a, b] : pairs.all()) {
      const Eigen::Vector3d back = guess.R_now_before.transpose() * b;
      const double w = geman_mcclure((a - back).squaredNorm() / (scale * scale), k * k);
      information += w * (Eigen::Matrix3d::Identity() - a * a.transpose());
      pull += w * a.cross(back);
      weight += w;
    }
    const Eigen::LLT<Eigen::Matrix3d> factors(information);
    const Eigen::Vector3d step = factors.solve(pull);
    if (factors.info() != Eigen::Success || !step.allFinite()) return false;
    guess.R_now_before = orthonormalized(guess.R_now_before * Exp(step));
    guess.covariance_rad2 = scale * scale * factors.solve(Eigen::Matrix3d::Identity());
    guess.agreement = weight / pairs.count;
    if (step.norm() < kConverged_rad) break;
  }
  return true;
}

}  // namespace lxd
