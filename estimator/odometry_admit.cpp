// SPDX-License-Identifier: Apache-2.0
// Which sweeps the odometry takes.
#include "estimator/odometry.hpp"

namespace lxd {
namespace {

constexpr std::uint32_t kPointsMin = 30;  // a sweep with fewer usable returns is no sweep
constexpr double kCarriedSigma_m = 5.0;  // the pose is not carried on without a LiDAR when it is less certain than that

}  // namespace

SweepRejection Odometry::admit(const Sweep& sweep) const {
  const bool seen = LidarReturns(lidar0_, sweep.points(), 0).has(kPointsMin);
  if (!seen && !carried_without(sweep)) return SweepRejection::too_few_points;
  if (phase_ != Phase::first_sweep && sweep.end <= last_end_) return SweepRejection::time_backwards;
  return SweepRejection::none;
}

// Do the other sensors tell where the body is when the primary LiDAR does not?
bool Odometry::carried_without(const Sweep& sweep) const {
  if (phase_ != Phase::tracking) return false;
  if (!extra_.empty() || (vision_ && vision_->waiting(sweep.end))) return true;
  const double variance_m2 = filter_.covariance().block<3, 3>(kPosition, kPosition).trace();
  return motion_.measured(last_end_, sweep.end) && variance_m2 < kCarriedSigma_m * kCarriedSigma_m;
}

}  // namespace lxd
