// SPDX-License-Identifier: Apache-2.0
// See rig_clock.hpp.
#include "drivers/replay/rig_clock.hpp"

namespace lxd {

bool RigClock::place(Sweep& sweep, Rejections& rejected) {
  if (model_.counts().steps > 0) rejected["clock_step"] = model_.counts().steps;
  const RigTime end = model_.to_rig(sweep.end.ns());
  if (last_ && end <= *last_) {
    count_rejected(rejected, end == *last_ ? "time_repeated" : "time_backwards");
    return false;
  }
  last_ = end;
  sweep.begin = end - (sweep.end - sweep.begin);
  sweep.end = sweep.stamp = end;
  return true;
}

}  // namespace lxd
