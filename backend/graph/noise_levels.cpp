// SPDX-License-Identifier: Apache-2.0
#include "backend/graph/noise_levels.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "backend/graph/fix_filter.hpp"

namespace lxd {
namespace {

constexpr std::size_t kFixesMin = 8;
constexpr std::array kDrifts{0.015, 0.03, 0.06, 0.12, 0.25, 0.5, 1.0, 2.0, 4.0};
constexpr std::array kCorrelations_s{0.1, 0.5, 2.5, 10.0, 30.0, 100.0};
constexpr std::array kJitters_s{0.0005, 0.002, 0.008, 0.03};
constexpr std::array kWhiteShares{0.3, 0.1, 0.03, 0.01, 0.003};
// The white share shows in fixes that follow each other, the rest in some of a long time.
constexpr std::size_t kSuccessiveMax = 256, kFixesMax = 2048;
// That the white share is sought beside.
constexpr std::array kDriftsBeside{0.0, 0.25, 2.0};
constexpr std::array kJittersBeside{0.0005, 0.008};
// Before any fix has come: between a gyroscope beside a good LiDAR, a tenth of what the chain says, and a LiDAR alone
// with a mediocre calibration.
constexpr double kDriftExpected = 0.3, kDriftSpread = 3;

// How the fixes may err: each time constant with each jitter.
constexpr int kNoises = static_cast<int>(kCorrelations_s.size() * kJitters_s.size());
using ByNoise = Eigen::Array<double, 1, kNoises>;
using ByDrift = Eigen::Array<double, static_cast<int>(kDrifts.size()), 1>;

double correlation_of(int noise) { return kCorrelations_s[static_cast<std::size_t>(noise) / kJitters_s.size()]; }
double jitter_of(int noise) { return kJitters_s[static_cast<std::size_t>(noise) % kJitters_s.size()]; }

// The logarithm of how likely the fixes are.
struct Likelihoods {
  Eigen::Array<double, ByDrift::RowsAtCompileTime, kNoises> drifting;  // where odometry drifts so far
  ByNoise still;                                                       // where it does not
};

template <class Axes>
Likelihoods likelihoods(std::span<const FixStep> steps, double white_share, double delay_sigma_s) {
  const std::vector<FixSight<Axes>> sights = sights_of<Axes>(steps, white_share);
  Likelihoods found;
  for (int noise = 0; noise < kNoises; ++noise) {
    const auto given = [&](double drift) {
      return log_likelihood<Axes>(sights, {drift, correlation_of(noise), jitter_of(noise)}, delay_sigma_s);
    };
    for (int i = 0; i < found.drifting.rows(); ++i)
      found.drifting(i, noise) = given(kDrifts[static_cast<std::size_t>(i)]);
    found.still[noise] = given(0);
  }
  return found;
}

// The logarithm of a sum of what is given by its logarithms.
template <class Logarithms>
double log_sum(const Logarithms& logarithms) {
  const double largest = logarithms.maxCoeff();
  return largest + std::log((logarithms - largest).exp().sum());
}

ByDrift logarithms_of_drifts() { return Eigen::Map<const ByDrift>(kDrifts.data()).log(); }

// Of the drifts, before any fix has come.
ByDrift log_priors() {
  const ByDrift off = (logarithms_of_drifts() - std::log(kDriftExpected)) / std::log(kDriftSpread);
  const ByDrift priors = -0.5 * off.square();
  return priors - log_sum(priors);
}

// How likely each noise is where odometry drifts, and the drift's mean on a logarithmic scale given that noise.
struct Drifting {
  ByNoise log_likelihood, log_drift;
};

Drifting drifting(const Likelihoods& found) {
  Drifting by;
  for (int noise = 0; noise < kNoises; ++noise) {
    const ByDrift joint = found.drifting.col(noise) + log_priors();
    by.log_likelihood[noise] = log_sum(joint);
    by.log_drift[noise] = ((joint - by.log_likelihood[noise]).exp() * logarithms_of_drifts()).sum();
  }
  return by;
}

// The logarithm of how likely the fixes are where so much of their variance is white, and the rest as suits it best.
template <class Axes>
double best_with(std::span<const FixStep> steps, double white_share, double delay_sigma_s) {
  const std::vector<FixSight<Axes>> sights = sights_of<Axes>(steps, white_share);
  double best = -std::numeric_limits<double>::infinity();
  for (const double correlation_s : kCorrelations_s)
    for (const double drift : kDriftsBeside)
      for (const double jitter_s : kJittersBeside)
        best = std::max(best, log_likelihood<Axes>(sights, {drift, correlation_s, jitter_s}, delay_sigma_s));
  return best;
}

double find_white_share(std::span<const FixStep> steps, double delay_sigma_s) {
  std::array<double, kWhiteShares.size()> found{};
  std::ranges::transform(kWhiteShares, found.begin(), [&](double share) {
    return best_with<LevelAxes>(steps, share, delay_sigma_s) + best_with<UpAxes>(steps, share, delay_sigma_s);
  });
  return kWhiteShares[static_cast<std::size_t>(std::ranges::max_element(found) - found.begin())];
}

std::vector<GnssMeasurement> thinned(std::span<const GnssMeasurement> fixes) {
  const std::size_t kept = std::min(fixes.size(), kFixesMax);
  std::vector<GnssMeasurement> some;
  for (std::size_t i = 0; i < kept; ++i) some.push_back(fixes[i * fixes.size() / kept]);
  return some;
}

}  // namespace

Matrix6d scaled(const RelativeMotion& motion, const Eigen::Matrix3d& R_map_a, const NoiseLevels& levels) {
  const double h = levels.drift_horizontal, v = levels.drift_vertical;
  const Eigen::Matrix3d R_map_b = R_map_a * motion.T.R;
  Matrix6d M = Matrix6d::Zero();
  M.topLeftCorner<3, 3>() = R_map_b.transpose() * Eigen::Vector3d(v, v, h).asDiagonal() * R_map_b;
  M.bottomRightCorner<3, 3>() = R_map_a.transpose() * Eigen::Vector3d(h, h, v).asDiagonal() * R_map_a;
  return M * motion.covariance * M.transpose();
}

// Means on a logarithmic scale, over what the fixes make likely. Heights have noise of their own in the odds: where a
// receiver claims too much or too little of them, that is no drift of level positions.
std::optional<NoiseLevels> find_noise_levels(const OdometryChain& chain, std::span<const GnssMeasurement> fixes,
                                             const Pose& T_enu_world, double delay_s, double delay_sigma_s) {
  if (fixes.size() < kFixesMin) return std::nullopt;
  const auto latest = fixes.last(std::min(fixes.size(), kSuccessiveMax));
  const double white_share = find_white_share(steps_of(chain, latest, T_enu_world, delay_s), delay_sigma_s);
  const std::vector<FixStep> steps = steps_of(chain, thinned(fixes), T_enu_world, delay_s);
  const Likelihoods horizontal = likelihoods<LevelAxes>(steps, white_share, delay_sigma_s);
  const Likelihoods vertical = likelihoods<UpAxes>(steps, white_share, delay_sigma_s);
  const Drifting h = drifting(horizontal), v = drifting(vertical);
  const double log_odds =
      log_sum(h.log_likelihood) - log_sum(horizontal.still) + log_sum(v.log_likelihood) - log_sum(vertical.still);
  if (!std::isfinite(log_odds)) return std::nullopt;  // the fixes are beyond numbers
  const ByNoise weights = (h.log_likelihood - log_sum(h.log_likelihood)).exp();
  double log_correlation = 0, log_jitter = 0;
  for (int noise = 0; noise < kNoises; ++noise) {
    log_correlation += weights[noise] * std::log(correlation_of(noise));
    log_jitter += weights[noise] * std::log(jitter_of(noise));
  }
  return NoiseLevels{.drift_horizontal = std::exp((weights * h.log_drift).sum()),
                     .drift_vertical = std::exp((weights * v.log_drift).sum()),
                     .white_share = white_share,
                     .correlation_s = std::exp(log_correlation),
                     .jitter_s = std::exp(log_jitter),
                     .log_odds_of_drift = log_odds};
}

}  // namespace lxd
