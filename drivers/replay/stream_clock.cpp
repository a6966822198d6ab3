// SPDX-License-Identifier: Apache-2.0
// See stream_clock.hpp.
#include "drivers/replay/stream_clock.hpp"

namespace lxd {

bool StreamClock::place(Sweep& sweep, Rejections& rejected) {
  if (!last_) to_rig_ = RigTime() - sweep.begin;
  if (!in_order(sweep.end, rejected)) return false;
  earlier_ = 0;
  last_ = sweep.end;
  sweep.begin = sweep.begin + to_rig_;
  sweep.end = sweep.stamp = sweep.end + to_rig_;
  return true;
}

bool StreamClock::in_order(RigTime end, Rejections& rejected) {
  if (!last_ || end > *last_) return true;
  if (end < *last_ && has_stepped(end)) {
    count_rejected(rejected, "clock_step");
    to_rig_ = to_rig_ + (*last_ + period_ - first_earlier_);
    return true;
  }
  count_rejected(rejected, end == *last_ ? "time_repeated" : "time_backwards");
  return false;
}

bool StreamClock::has_stepped(RigTime end) {
  const bool follows = earlier_ > 0 && end > last_earlier_;
  if (!follows) first_earlier_ = end;
  earlier_ = follows ? earlier_ + 1 : 1;
  last_earlier_ = end;
  return earlier_ == kStepSweeps;
}

}  // namespace lxd
