// SPDX-License-Identifier: Apache-2.0
#include "board/sweep_gaps.hpp"

namespace lxd {
namespace {

// Of a period: so much later than its time, the next sweep still follows upon the last.
Duration late_max(Duration period) { return period * 9 / 10; }

Sweep times_of(const Sweep& sweep) {
  Sweep times;
  times.begin = sweep.begin;
  times.end = sweep.end;
  times.stamp = sweep.stamp;
  times.lidar = sweep.lidar;
  return times;
}

}  // namespace

std::optional<Sweep> SweepGaps::missing(RigTime begin) const {
  if (!last_ || !period_ || begin - last_->begin < *period_ + late_max(*period_)) return std::nullopt;
  return next();
}

std::optional<Sweep> SweepGaps::next() const {
  if (!last_ || !period_) return std::nullopt;
  Sweep sweep = *last_;
  for (RigTime* const t : {&sweep.begin, &sweep.end, &sweep.stamp}) *t = *t + *period_;
  return sweep;
}

// The first rhythm may be that of a gap: a quicker one replaces it.
void SweepGaps::came(const Sweep& sweep) {
  if (last_ && last_came_) {
    const Duration since = sweep.begin - last_->begin;
    if (since.ns() > 0 && (!period_ || since < *period_ + late_max(*period_))) period_ = since;
  }
  last_ = times_of(sweep);
  last_came_ = true;
}

void SweepGaps::carried(const Sweep& missing) {
  last_ = times_of(missing);
  last_came_ = false;
}

}  // namespace lxd
