// SPDX-License-Identifier: Apache-2.0
// Which sweeps are missing while the primary LiDAR is silent.
#include <gtest/gtest.h>

#include "board/sweep_gaps.hpp"

namespace lxd::board_sweep_gaps_test {
namespace {

constexpr Duration kPeriod = Duration::from_ns(100'000'000), kSpan = Duration::from_ns(90'000'000);

RigTime at(double periods) { return RigTime::from_ns(1'000'000'000) + Duration::from_seconds(0.1 * periods); }

Sweep sweep_at(double periods) {
  Sweep sweep;
  sweep.begin = sweep.stamp = at(periods);
  sweep.end = sweep.begin + kSpan;
  return sweep;
}

TEST(SweepGaps, OneSweepHasNoRhythm) {
  SweepGaps gaps;
  EXPECT_FALSE(gaps.next());
  gaps.came(sweep_at(0));
  EXPECT_FALSE(gaps.missing(at(50)));
}

// Given sweeps of 10 Hz; when the next one is a little late, none is missing; when one or three did not come, each of
// them is told with the times that it would have had.
TEST(SweepGaps, MissingOnesHaveTheTimesTheyWouldHaveHad) {
  SweepGaps gaps;
  gaps.came(sweep_at(0));
  gaps.came(sweep_at(1));
  EXPECT_FALSE(gaps.missing(at(2)));
  EXPECT_FALSE(gaps.missing(at(2.8)));
  for (int i = 2; i < 5; ++i) {
    const auto missing = gaps.missing(at(5));
    ASSERT_TRUE(missing) << i;
    EXPECT_EQ(missing->begin, at(i));
    EXPECT_EQ(missing->stamp, at(i));
    EXPECT_EQ(missing->end, at(i) + kSpan);
    EXPECT_EQ(missing->count, 0U);
    gaps.carried(*missing);
  }
  EXPECT_FALSE(gaps.missing(at(5)));
}

TEST(SweepGaps, ARhythmThatBeganWithAGapIsMended) {
  SweepGaps gaps;
  gaps.came(sweep_at(0));
  gaps.came(sweep_at(3));
  gaps.came(sweep_at(4));
  const auto missing = gaps.missing(at(6));
  ASSERT_TRUE(missing);
  EXPECT_EQ(missing->begin, at(5));
}

TEST(SweepGaps, NoneIsMissingOnceNothingCarriesThePose) {
  SweepGaps gaps;
  gaps.came(sweep_at(0));
  gaps.came(sweep_at(1));
  gaps.give_up();
  EXPECT_FALSE(gaps.missing(at(9)));
  EXPECT_FALSE(gaps.next());
  gaps.came(sweep_at(9));
  const auto missing = gaps.missing(at(12));
  ASSERT_TRUE(missing);  // the rhythm is known still
  EXPECT_EQ(missing->begin, at(10));
}

}  // namespace
}  // namespace lxd::board_sweep_gaps_test
