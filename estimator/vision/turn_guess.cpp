// SPDX-License-Identifier: Apache-2.0
#include "estimator/vision/turn_guess.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <Eigen/Cholesky>

#include "estimator/normal_equations.hpp"
#include "estimator/vision/feature_frame.hpp"

namespace lxd {
namespace {

constexpr std::size_t kPairsMin = 8;
constexpr int kIterations = 12;
constexpr double kMedianToSigma = 0.8493;  // of the length of a vector of two normal errors: 1 / sqrt(2 ln 2)
constexpr double kConverged_rad = 1e-6;
constexpr double kScaleMin = 0.25;  // features may agree better than a careful noise says, but not by more
constexpr double kShiftFloor_m = 1e-6;

// Of the camera: its turn, and where it was before, seen from where it is, in the axes that it had before.
struct CameraMotion {
  Eigen::Matrix3d R_now_before;
  Eigen::Vector3d shift_m;
};

// Where a feature should be and is, as bearings in the axes of before; d(error) / d(shift) is per_m (1 - q q^T).
struct Bearings {
  Eigen::Vector3d expected, seen;
  double per_m;
};

Bearings bearings_of(const TurnPair& pair, const CameraMotion& motion) {
  const Eigen::Vector3d point = pair.before + pair.rho * motion.shift_m;
  const double length = point.norm();
  return {point / length, motion.R_now_before.transpose() * pair.now, pair.rho / length};
}

// A bearing's noise, and what a wrong distance makes of the way.
double variance_of(const TurnPair& pair, const TurnExpected& expected, double sigma_rad) {
  const double way2 = expected.T_now_before.p.squaredNorm() + 3 * expected.shift_sigma_m * expected.shift_sigma_m;
  return sigma_rad * sigma_rad + pair.rho_sigma * pair.rho_sigma * way2;
}

// 1.48 medians of one axis' error in sigmas.
double scale_of(std::span<const TurnPair> pairs, const TurnExpected& expected, double sigma_rad,
                const CameraMotion& motion) {
  std::array<double, kFeaturesMax> ratios;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    const Bearings b = bearings_of(pairs[i], motion);
    ratios[i] = (b.expected - b.seen).norm() / std::sqrt(variance_of(pairs[i], expected, sigma_rad));
  }
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(pairs.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.begin() + static_cast<std::ptrdiff_t>(pairs.size()));
  return std::max(kScaleMin, kMedianToSigma * *middle);
}

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

// Of [turn, shift].
struct TurnSums {
  Matrix6 information = Matrix6::Zero();
  Vector6 pull = Vector6::Zero();
  double weight = 0;  // 0..1, of the pairs
};

// e = q - R^T b, R <- R Exp(dtheta): H = [-(R^T b)^, per_m (1 - q q^T)].
void add(const Bearings& b, double variance, double squared_kernel, TurnSums& sums) {
  const Eigen::Vector3d e = b.expected - b.seen;
  const double w = geman_mcclure(e.squaredNorm() / variance, squared_kernel);
  Eigen::Matrix<double, 3, 6> H;
  H.leftCols<3>() = -hat(b.seen);
  H.rightCols<3>() = b.per_m * (Eigen::Matrix3d::Identity() - b.expected * b.expected.transpose());
  sums.information.noalias() += (w / variance) * H.transpose() * H;
  sums.pull.noalias() -= (w / variance) * H.transpose() * e;
  sums.weight += w;
}

}  // namespace

bool guess_turn(std::span<const TurnPair> pairs, const TurnExpected& expected, double sigma_rad,
                TurnGuess& guess) noexcept {
  pairs = pairs.first(std::min<std::size_t>(pairs.size(), kFeaturesMax));
  guess = {expected.T_now_before.R, Eigen::Matrix3d::Zero(), static_cast<std::uint32_t>(pairs.size()), 0};
  if (pairs.size() < kPairsMin) return false;
  const double shift_sigma_m = std::max(expected.shift_sigma_m, kShiftFloor_m);
  const double held = 1 / (shift_sigma_m * shift_sigma_m);
  const Eigen::Vector3d shift_m = expected.T_now_before.R.transpose() * expected.T_now_before.p;
  CameraMotion motion{expected.T_now_before.R, shift_m};
  for (int i = 0; i < kIterations; ++i) {
    const double scale = scale_of(pairs, expected, sigma_rad, motion), k = kernel_sigmas(i);
    TurnSums sums;
    for (const TurnPair& pair : pairs)
      add(bearings_of(pair, motion), scale * scale * variance_of(pair, expected, sigma_rad), k * k, sums);
    sums.information.diagonal().tail<3>().array() += held;
    sums.pull.tail<3>() -= held * (motion.shift_m - shift_m);
    const Eigen::LLT<Matrix6> factors(sums.information);
    const Vector6 step = factors.solve(sums.pull);
    if (factors.info() != Eigen::Success || !step.allFinite()) return false;
    motion.R_now_before = orthonormalized(motion.R_now_before * Exp(step.head<3>()));
    motion.shift_m += step.tail<3>();
    guess.R_now_before = motion.R_now_before;
    guess.covariance_rad2 = factors.solve(Matrix6::Identity()).topLeftCorner<3, 3>();
    guess.agreement = sums.weight / static_cast<double>(pairs.size());
    if (step.head<3>().norm() < kConverged_rad) break;
  }
  return true;
}

}  // namespace lxd
