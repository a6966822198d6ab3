// SPDX-License-Identifier: Apache-2.0
// Interpolation of truth at the estimate's stamps.
#include "tools/evaluate/associate.hpp"

#include <algorithm>
#include <optional>

namespace lxd {
namespace {

Pose interpolate(const StampedPose& a, const StampedPose& b, RigTime stamp) {
  const double fraction = (stamp - a.stamp).seconds() / (b.stamp - a.stamp).seconds();
  Pose T;
  T.R = a.T.quaternion().slerp(fraction, b.T.quaternion()).toRotationMatrix();
  T.p = a.T.p + fraction * (b.T.p - a.T.p);
  return T;
}

std::optional<Pose> truth_at(const std::vector<StampedPose>& truth, RigTime stamp, Duration gap_max) {
  const auto after = std::ranges::lower_bound(truth, stamp, {}, &StampedPose::stamp);
  if (after != truth.end() && after->stamp == stamp) return after->T;
  if (after == truth.begin()) return after->stamp - stamp <= kEndTolerance ? std::optional(after->T) : std::nullopt;
  const auto before = std::prev(after);
  if (after == truth.end()) return stamp - before->stamp <= kEndTolerance ? std::optional(before->T) : std::nullopt;
  if (after->stamp - before->stamp > gap_max) return std::nullopt;
  return interpolate(*before, *after, stamp);
}

}  // namespace

Association associate(const Trajectory& estimate, const Trajectory& truth, Duration gap_max) {
  Association association;
  for (const StampedPose& pose : estimate.poses) {
    const std::optional<Pose> T = truth_at(truth.poses, pose.stamp, gap_max);
    if (T)
      association.pairs.push_back({pose.stamp, pose.T, *T});
    else
      ++association.unmatched;
  }
  return association;
}

}  // namespace lxd
