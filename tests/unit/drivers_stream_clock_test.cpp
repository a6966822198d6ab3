// SPDX-License-Identifier: Apache-2.0
// A sensor's clock on the rig's: rig time only increases, whatever the sensor's does.
#include <vector>

#include <gtest/gtest.h>

#include "drivers/replay/stream_clock.hpp"

namespace lxd::drivers_stream_clock_test {
namespace {

constexpr std::int64_t kMilli_ns = 1'000'000;

class StreamClockStory : public testing::Test {
 protected:
  // Sweeps of 90 ms that end at these sensor times; where those that pass end on the rig.
  std::vector<std::int64_t> ends_ms(const std::vector<std::int64_t>& sensor_ends_ms) {
    std::vector<std::int64_t> ends;
    for (const std::int64_t end_ms : sensor_ends_ms) {
      Sweep sweep;
      sweep.end = RigTime::from_ns(end_ms * kMilli_ns);
      sweep.begin = sweep.end - Duration::from_ns(90 * kMilli_ns);
      if (!clock_.place(sweep, rejected_)) continue;
      EXPECT_EQ((sweep.end - sweep.begin).ns(), 90 * kMilli_ns);
      EXPECT_EQ(sweep.stamp, sweep.end);
      ends.push_back(sweep.end.ns() / kMilli_ns);
    }
    return ends;
  }

  StreamClock clock_{Duration::from_ns(100 * kMilli_ns)};
  Rejections rejected_;
};

using Ends = std::vector<std::int64_t>;

TEST_F(StreamClockStory, RigTimeBeginsWithTheFirstSweep) {
  EXPECT_EQ(ends_ms({5000, 5100, 5230, 9000}), (Ends{90, 190, 320, 4090}));
  EXPECT_TRUE(rejected_.empty());
}

TEST_F(StreamClockStory, OneOrTwoEarlierSweepsAreDamage) {
  EXPECT_EQ(ends_ms({5000, 4900, 5200, 5300, 100, 200, 5600}), (Ends{90, 290, 390, 690}));
  EXPECT_EQ(rejected_, (Rejections{{"time_backwards", 3}}));
}

TEST_F(StreamClockStory, RepeatedTimeIsNoStep) {
  EXPECT_EQ(ends_ms({5000, 5000, 5000, 5000, 5100}), (Ends{90, 190}));
  EXPECT_EQ(rejected_, (Rejections{{"time_repeated", 3}}));
}

TEST_F(StreamClockStory, EarlierSweepsOutOfOrderAreNoStep) {
  EXPECT_EQ(ends_ms({5000, 400, 300, 300, 200, 5100}), (Ends{90, 190}));
  EXPECT_EQ(rejected_, (Rejections{{"time_backwards", 4}}));
}

// The first two after the restart are lost; time is as if none were.
TEST_F(StreamClockStory, RestartedSensorGoesOnInRigTime) {
  EXPECT_EQ(ends_ms({5000, 5100, 100, 200, 300, 400, 500}), (Ends{90, 190, 490, 590, 690}));
  EXPECT_EQ(rejected_, (Rejections{{"time_backwards", 2}, {"clock_step", 1}}));
}

TEST_F(StreamClockStory, EveryRestartIsCounted) {
  EXPECT_EQ(ends_ms({5000, 100, 200, 300, 50, 150, 250, 350}), (Ends{90, 390, 690, 790}));
  EXPECT_EQ(rejected_, (Rejections{{"time_backwards", 4}, {"clock_step", 2}}));
}

TEST_F(StreamClockStory, OneSweepFarTooLateCostsTwo) {
  EXPECT_EQ(ends_ms({5000, 900'000, 5200, 5300, 5400, 5500}).size(), 4U);
  EXPECT_EQ(rejected_, (Rejections{{"time_backwards", 2}, {"clock_step", 1}}));
}

}  // namespace
}  // namespace lxd::drivers_stream_clock_test
