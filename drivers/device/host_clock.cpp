// SPDX-License-Identifier: Apache-2.0
#include "drivers/device/host_clock.hpp"

#include <ctime>

namespace lxd {
namespace {

std::int64_t read_ns(clockid_t clock) {
  timespec t{};
  ::clock_gettime(clock, &t);
  return std::int64_t{t.tv_sec} * kNanosPerSecond + t.tv_nsec;
}

struct ClockPair {
  std::int64_t monotonic_ns, realtime_ns;  // of one instant, to a few microseconds
};

// The realtime clock is read between two looks at the other; of some tries the one that was interrupted least.
ClockPair read_both() {
  constexpr int kTries = 3;
  ClockPair best{};
  std::int64_t shortest_ns = INT64_MAX;
  for (int i = 0; i < kTries; ++i) {
    const std::int64_t before = read_ns(CLOCK_MONOTONIC);
    const std::int64_t realtime = read_ns(CLOCK_REALTIME);
    const std::int64_t took_ns = read_ns(CLOCK_MONOTONIC) - before;
    if (took_ns >= shortest_ns) continue;
    shortest_ns = took_ns;
    best = {before + took_ns / 2, realtime};
  }
  return best;
}

}  // namespace

HostClock::HostClock() {
  const ClockPair now = read_both();
  rig_minus_monotonic_ns_ = now.realtime_ns - now.monotonic_ns;
}

RigTime HostClock::now() const { return of_monotonic(read_ns(CLOCK_MONOTONIC)); }

RigTime HostClock::of_monotonic(std::int64_t stamp_ns) const {
  return RigTime::from_ns(stamp_ns + rig_minus_monotonic_ns_);
}

RigTime HostClock::of_realtime(std::int64_t stamp_ns) const {
  const ClockPair pair = read_both();
  const std::int64_t age_ns = pair.realtime_ns - stamp_ns;
  const RigTime read = of_monotonic(pair.monotonic_ns);
  return age_ns < 0 || age_ns > kOldestStamp.ns() ? read : read - Duration::from_ns(age_ns);
}

Duration HostClock::host_ahead() const {
  const ClockPair pair = read_both();
  return Duration::from_ns(pair.realtime_ns - pair.monotonic_ns - rig_minus_monotonic_ns_);
}

}  // namespace lxd
