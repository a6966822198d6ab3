// SPDX-License-Identifier: Apache-2.0
#include "backend/graph/earth_alignment.hpp"

#include <algorithm>
#include <cmath>

namespace lxd {
namespace {

constexpr std::size_t kPairsMin = 8;
constexpr double kAgreeingShare = 0.7;
constexpr double kFitSigmas = 3;
// Of the way, at least: the yaw is then known to a sixth of a radian.
constexpr double kSpread_m = 10;
constexpr double kSpreadSigmas = 6;
constexpr std::size_t kTrials = 64;

struct Sums {
  double weight = 0;
  Eigen::Vector3d map_m = Eigen::Vector3d::Zero(), enu_m = Eigen::Vector3d::Zero();
};

Sums means_of(std::span<const AlignmentPair> pairs, const std::vector<bool>& in) {
  Sums sums;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!in[i]) continue;
    const double w = 1 / (pairs[i].sigma_m * pairs[i].sigma_m);
    sums.weight += w;
    sums.map_m += w * pairs[i].map_m;
    sums.enu_m += w * pairs[i].enu_m;
  }
  sums.map_m /= sums.weight;
  sums.enu_m /= sums.weight;
  return sums;
}

// Least squares of yaw and offset: the yaw turns the horizontal parts, about their means, onto each other.
EarthAlignment fit(std::span<const AlignmentPair> pairs, const std::vector<bool>& in) {
  const Sums mean = means_of(pairs, in);
  double along = 0, across = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!in[i]) continue;
    const double w = 1 / (pairs[i].sigma_m * pairs[i].sigma_m);
    const Eigen::Vector3d a = pairs[i].map_m - mean.map_m, b = pairs[i].enu_m - mean.enu_m;
    along += w * (a.x() * b.x() + a.y() * b.y());
    across += w * (a.x() * b.y() - a.y() * b.x());
  }
  EarthAlignment alignment;
  alignment.yaw_rad = std::atan2(across, along);
  alignment.offset_m = mean.enu_m - alignment.to_enu(mean.map_m);
  return alignment;
}

std::vector<bool> fitting(std::span<const AlignmentPair> pairs, const EarthAlignment& alignment) {
  std::vector<bool> in(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Eigen::Vector3d error = alignment.to_enu(pairs[i].map_m) - pairs[i].enu_m;
    in[i] = error.head<2>().norm() < kFitSigmas * pairs[i].sigma_m;
  }
  return in;
}

std::size_t count(const std::vector<bool>& in) { return static_cast<std::size_t>(std::ranges::count(in, true)); }

// The alignment by two of the pairs that most others agree with; the two lie half of all apart, in turn.
EarthAlignment best_of_two(std::span<const AlignmentPair> pairs) {
  EarthAlignment best;
  std::size_t most = 0;
  const std::size_t half = pairs.size() / 2, stride = std::max<std::size_t>(1, half / kTrials);
  for (std::size_t i = 0; i < half; i += stride) {
    std::vector<bool> two(pairs.size());
    two[i] = two[i + half] = true;
    const EarthAlignment alignment = fit(pairs, two);
    const std::size_t agreeing = count(fitting(pairs, alignment));
    if (agreeing <= most) continue;
    most = agreeing;
    best = alignment;
  }
  return best;
}

bool spread_enough(std::span<const AlignmentPair> pairs, const std::vector<bool>& in) {
  const Sums mean = means_of(pairs, in);
  double square_m2 = 0, sigma_m = 0;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    if (!in[i]) continue;
    square_m2 += (pairs[i].map_m - mean.map_m).head<2>().squaredNorm();
    sigma_m += pairs[i].sigma_m;
  }
  const auto n = static_cast<double>(count(in));
  return std::sqrt(square_m2 / n) > std::max(kSpread_m, kSpreadSigmas * sigma_m / n);
}

}  // namespace

std::optional<AlignmentFit> fit_alignment(std::span<const AlignmentPair> pairs) {
  if (pairs.size() < kPairsMin) return std::nullopt;
  AlignmentFit result{best_of_two(pairs), {}};
  constexpr int kRefinements = 3;
  for (int i = 0; i < kRefinements; ++i) {
    result.fits = fitting(pairs, result.alignment);
    if (static_cast<double>(count(result.fits)) < kAgreeingShare * static_cast<double>(pairs.size()))
      return std::nullopt;
    result.alignment = fit(pairs, result.fits);
  }
  result.fits = fitting(pairs, result.alignment);
  if (count(result.fits) < kPairsMin || !spread_enough(pairs, result.fits)) return std::nullopt;
  return result;
}

}  // namespace lxd
