// SPDX-License-Identifier: Apache-2.0
#include "estimator/vision/camera_delay.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "estimator/normal_equations.hpp"

namespace lxd {
namespace {

// A camera's clock is set by a host or a trigger: 0.15 ms in a minute, as the IMU's.
constexpr double kWalk_s_per_sqrt_s = 2e-5;
constexpr double kDelayMax_s = 0.05;           // sensors that are farther apart than this are no rig
constexpr double kRateChangeMin_radps = 0.05;  // between two images: less is the gyroscope's noise
constexpr double kPathSigma_rad = 1e-4;        // of the path's turn, an axis
constexpr double kImagesAlike = 10;            // so many neighbouring images err alike
constexpr double kRestGate = 13.8;             // chi-square, two degrees of freedom, 0.999
constexpr double kMisfitShare = 0.05;          // of one turn in the running mean
constexpr double kKernel_sigmas = 3;

}  // namespace

void CameraDelay::pass(Duration span) noexcept {
  if (!known()) variance_s2_ += kWalk_s_per_sqrt_s * kWalk_s_per_sqrt_s * std::max(0.0, span.seconds());
}

// lacking = by_delay d + noise: along by_delay it tells d, across it how far the noise is believed.
void CameraDelay::learn(const Eigen::Vector3d& lacking, const Eigen::Vector3d& by_delay,
                        const Eigen::Matrix3d& covariance) noexcept {
  if (known() || !lacking.allFinite() || !(by_delay.norm() > kRateChangeMin_radps)) return;
  const Eigen::LLT<Eigen::Matrix3d> factors(covariance + kPathSigma_rad * kPathSigma_rad * Eigen::Matrix3d::Identity());
  if (factors.info() != Eigen::Success) return;
  const Eigen::Vector3d weighed = factors.solve(by_delay);
  const double information = weighed.dot(by_delay), off_s = weighed.dot(lacking) / information;
  const double rest = lacking.dot(factors.solve(lacking)) - off_s * off_s * information;
  const bool fits = rest < kRestGate * misfit_;
  misfit_ = std::max(1.0, misfit_ + kMisfitShare * (std::min(rest / 2, kRestGate * misfit_) - misfit_));
  if (!fits || !(std::abs(off_s) < 2 * kDelayMax_s)) return;
  const double ratio = off_s * off_s / (misfit_ / information + variance_s2_);
  const double weight = geman_mcclure(ratio, kKernel_sigmas * kKernel_sigmas);
  const double believed = weight * information / (kImagesAlike * misfit_);
  variance_s2_ /= 1 + variance_s2_ * believed;
  delay_s_ = std::clamp(delay_s_ + variance_s2_ * believed * off_s, -kDelayMax_s, kDelayMax_s);
}

void CameraDelay::follow(RigTime end, const Eigen::Matrix3d& R_world_body, const ImageTurn* seen) noexcept {
  attitudes_.add(end, R_world_body);
  if (seen != nullptr && waiting_count_ < kWaiting) waiting_[waiting_count_++] = *seen;
  while (waiting_count_ > 0 && attitudes_.knows(waiting_[0].now - delay())) {
    compare(waiting_[0], [this](RigTime then, RigTime now) { return attitudes_.turn(then, now); });
    std::copy(waiting_.begin() + 1, waiting_.begin() + static_cast<std::ptrdiff_t>(waiting_count_), waiting_.begin());
    --waiting_count_;
  }
}

}  // namespace lxd
