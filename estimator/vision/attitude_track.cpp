// SPDX-License-Identifier: Apache-2.0
#include "estimator/vision/attitude_track.hpp"

namespace lxd {
namespace {

constexpr Duration kApartMax = Duration::from_ns(250'000'000);  // two sweeps of 10 Hz, one of which was lost

}  // namespace

void AttitudeTrack::add(RigTime t, const Eigen::Matrix3d& R_world_body) noexcept {
  if (count_ > 0 && t - at(count_ - 1).t > kApartMax) clear();
  if (count_ == kEnds)
    first_ = (first_ + 1) % kEnds;
  else
    ++count_;
  ends_[(first_ + count_ - 1) % kEnds] = {t, R_world_body};
}

// The cubic through four ends, of rotation vectors from the second of them.
std::optional<Eigen::Matrix3d> AttitudeTrack::attitude(RigTime t) const noexcept {
  std::uint32_t i = 1;
  while (i + 2 < count_ && at(i + 1).t < t) ++i;
  if (i + 2 >= count_ || t < at(i).t || t > at(i + 1).t) return std::nullopt;
  const End& from = at(i);
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();
  for (std::uint32_t k = i - 1; k <= i + 2; ++k) {
    double share = 1;  // Lagrange's
    for (std::uint32_t other = i - 1; other <= i + 2; ++other)
      if (other != k) share *= (t - at(other).t).seconds() / (at(k).t - at(other).t).seconds();
    if (k != i) turned += share * Log(from.R.transpose() * at(k).R);
  }
  return from.R * Exp(turned);
}

std::optional<Eigen::Matrix3d> AttitudeTrack::turn(RigTime then, RigTime now) const noexcept {
  const auto before = attitude(then), after = attitude(now);
  if (!before || !after) return std::nullopt;
  return before->transpose() * *after;
}

}  // namespace lxd
