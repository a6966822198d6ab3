// SPDX-License-Identifier: Apache-2.0
// A sensor's sweeps on the clock of the host that recorded them.
#include <gtest/gtest.h>

#include "drivers/replay/rig_clock.hpp"

namespace lxd::drivers_rig_clock_test {
namespace {

constexpr std::int64_t kEpoch_ns = 1'767'268'800 * kNanosPerSecond;  // of the host
constexpr std::int64_t kStart_ns = 60 * kNanosPerSecond;             // of the sensor: since it was switched on
constexpr std::int64_t kLatency_ns = 300'000;
constexpr std::int64_t kPacket_ns = 1'562'500, kSweep_ns = 100'000'000;

// A sensor whose packets take kLatency_ns to the host, plus `shift_ns` of a clock that has stepped.
class Rig {
 public:
  void run(std::int64_t from_ns, std::int64_t to_ns, std::int64_t shift_ns = 0) {
    for (std::int64_t t = from_ns; t <= to_ns; t += kPacket_ns)
      clock_.observe(kStart_ns + t + shift_ns, RigTime::from_ns(kEpoch_ns + t + kLatency_ns));
  }
  // The end of the sweep that ends at t, as it was placed; none: it was passed over.
  std::optional<RigTime> place(std::int64_t t, std::int64_t shift_ns = 0) {
    Sweep sweep;
    sweep.begin = RigTime::from_ns(kStart_ns + t + shift_ns - kSweep_ns);
    sweep.end = sweep.stamp = RigTime::from_ns(kStart_ns + t + shift_ns);
    if (!clock_.place(sweep, rejected)) return std::nullopt;
    EXPECT_EQ(sweep.end - sweep.begin, Duration::from_ns(kSweep_ns));
    EXPECT_EQ(sweep.stamp, sweep.end);
    return sweep.end;
  }

  Rejections rejected;

 private:
  RigClock clock_{ClockModelConfig{}};
};

TEST(RigClock, PutsSweepsWhereTheHostSawThem) {
  Rig rig;
  rig.run(0, 20 * kNanosPerSecond);
  const auto end = rig.place(20 * kNanosPerSecond);
  ASSERT_TRUE(end);
  EXPECT_NEAR(static_cast<double>(end->ns() - kEpoch_ns - 20 * kNanosPerSecond), kLatency_ns, 1000);
  EXPECT_TRUE(rig.rejected.empty());
}

TEST(RigClock, PassesOverASweepThatDoesNotEndLater) {
  Rig rig;
  rig.run(0, kNanosPerSecond);
  EXPECT_TRUE(rig.place(kNanosPerSecond));
  EXPECT_FALSE(rig.place(kNanosPerSecond));
  EXPECT_FALSE(rig.place(kNanosPerSecond / 2));
  EXPECT_EQ(rig.rejected, (Rejections{{"time_repeated", 1}, {"time_backwards", 1}}));
}

TEST(RigClock, FollowsASensorThatCountsFromZeroAgainAndSaysSoOnce) {
  Rig rig;
  rig.run(0, 10 * kNanosPerSecond);
  EXPECT_TRUE(rig.place(10 * kNanosPerSecond));
  const std::int64_t shift_ns = -kStart_ns - 11 * kNanosPerSecond;  // its zero is at 11 s
  rig.run(12 * kNanosPerSecond, 13 * kNanosPerSecond, shift_ns);
  const auto end = rig.place(13 * kNanosPerSecond, shift_ns);
  ASSERT_TRUE(end);
  EXPECT_NEAR(static_cast<double>(end->ns() - kEpoch_ns - 13 * kNanosPerSecond), kLatency_ns, 10'000);
  EXPECT_EQ(rig.rejected, (Rejections{{"clock_step", 1}}));
}

}  // namespace
}  // namespace lxd::drivers_rig_clock_test
