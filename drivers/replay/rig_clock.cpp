// SPDX-License-Identifier: Apache-2.0
// See rig_clock.hpp.
#include "drivers/replay/rig_clock.hpp"

namespace lxd {
namespace {

constexpr Duration kStraddled = Duration::from_ns(300'000'000);  // longer than a sweep and its way to the host

Duration apart(RigTime a, RigTime b) { return a > b ? a - b : b - a; }

}  // namespace

void RigClock::observe(std::int64_t sensor_ns, RigTime received) {
  while (const auto pulse = pulses_.due(received)) (void)model_.add_edge(*pulse);
  const RigTime before = model_.to_rig(sensor_ns);
  newest_ = received;
  if (model_.add(sensor_ns, received) != ClockVerdict::stepped) return;
  undo_ = before - model_.to_rig(sensor_ns);
  stepped_ = received;
}

RigTime RigClock::placed(RigTime sensor) const {
  const RigTime now = model_.to_rig(sensor.ns());
  if (!stepped_ || *newest_ - *stepped_ > kStraddled) return now;
  const RigTime before = now + undo_;
  return apart(before, *newest_) < apart(now, *newest_) ? before : now;
}

bool RigClock::place(Sweep& sweep, Rejections& rejected) {
  if (model_.counts().steps > 0) rejected["clock_step"] = model_.counts().steps;
  const RigTime end = placed(sweep.end);
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
