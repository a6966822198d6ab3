// SPDX-License-Identifier: Apache-2.0
#include "estimator/sweep_path.hpp"

namespace lxd {

void SweepPath::set(const State& end, Duration span) {
  end_ = end;
  intervals_per_ns_ = span.ns() > 0 ? static_cast<float>(kIntervals / static_cast<double>(span.ns())) : 0.0f;
  for (int i = 0; i <= kIntervals; ++i) {
    knots_[i] = knot(end, span.seconds() * (kIntervals - i) / kIntervals);
    float_knots_[i] = {knots_[i].R.cast<float>(), (knots_[i].p - end.p).cast<float>()};
  }
}

PathKnot SweepPath::knot(const State& end, double before_end_s) {
  const Eigen::Vector3d psi = end.b_g * before_end_s;
  const Eigen::Matrix3d turn = Exp(psi);
  return {end.R * turn, end.p - end.v * before_end_s, turn, Jr(-psi), before_end_s};
}

Pose SweepPath::pose_at(Duration before_end) const {
  const PathKnot k = knot(end_, before_end.seconds());
  return {k.R, k.p};
}

}  // namespace lxd
