// SPDX-License-Identifier: Apache-2.0
// The rig's clock on a live rig, and the stamps of both host clocks on it.
#include <ctime>

#include <gtest/gtest.h>

#include "drivers/device/host_clock.hpp"

namespace lxd::drivers_host_clock_test {
namespace {

std::int64_t read_ns(clockid_t clock) {
  timespec t{};
  ::clock_gettime(clock, &t);
  return std::int64_t{t.tv_sec} * kNanosPerSecond + t.tv_nsec;
}

constexpr std::int64_t kMillisecond_ns = 1'000'000;

// Given a new clock, then its time is the host's of 1970, and it never goes back.
TEST(HostClock, CountsFrom1970AndGoesForward) {
  const std::int64_t before = read_ns(CLOCK_REALTIME);
  const HostClock clock;
  RigTime last = clock.now();
  EXPECT_GE(last.ns(), before - kMillisecond_ns);
  EXPECT_LE(last.ns(), read_ns(CLOCK_REALTIME) + kMillisecond_ns);
  for (int i = 0; i < 1000; ++i) {
    const RigTime now = clock.now();
    EXPECT_GE(now, last);
    last = now;
  }
}

// Given stamps that the kernel made between two looks at the clock, then they lie between those, by either clock.
TEST(HostClock, PlacesStampsOfBothClocksBetweenTheInstantsAroundThem) {
  const HostClock clock;
  const Duration slack = Duration::from_ns(kMillisecond_ns);
  const RigTime before = clock.now();
  const std::int64_t realtime = read_ns(CLOCK_REALTIME), monotonic = read_ns(CLOCK_MONOTONIC);
  const RigTime after = clock.now();
  EXPECT_GE(clock.of_realtime(realtime), before - slack);
  EXPECT_LE(clock.of_realtime(realtime), after + slack);
  EXPECT_GE(clock.of_monotonic(monotonic), before);
  EXPECT_LE(clock.of_monotonic(monotonic), after);
}

// Given stamps from before the host's clock was set (of the future, or long ago), then the time of reading is taken.
TEST(HostClock, TakesTheTimeOfReadingForAStampOfAnotherSetting) {
  const HostClock clock;
  const std::int64_t hour_ns = 3600 * kNanosPerSecond;
  for (const std::int64_t shift_ns : {hour_ns, -hour_ns}) {
    const RigTime before = clock.now();
    const RigTime stamp = clock.of_realtime(read_ns(CLOCK_REALTIME) + shift_ns);
    EXPECT_GE(stamp, before);
    EXPECT_LE(stamp, clock.now());
  }
}

TEST(HostClock, SaysThatTheHostsClockWasNotSet) {
  const HostClock clock;
  EXPECT_LT(std::abs(clock.host_ahead().ns()), 100 * kMillisecond_ns);
}

}  // namespace
}  // namespace lxd::drivers_host_clock_test
