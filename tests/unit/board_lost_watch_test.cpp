// SPDX-License-Identifier: Apache-2.0
// When a filter is lost for good.
#include <gtest/gtest.h>

#include "board/lost_watch.hpp"

namespace lxd::board_lost_watch_test {
namespace {

SweepOutcome sweep(double t_s, bool tracked, bool carried = false) {
  SweepOutcome outcome;
  outcome.stamp = RigTime::from_seconds(100 + t_s);
  outcome.tracked = tracked;
  outcome.carried = carried;
  return outcome;
}

TEST(LostWatch, OnlyATimeWithoutAnyPoseThatHoldsCounts) {
  LostWatch watch(3);
  EXPECT_FALSE(watch.lost(sweep(0, false)));  // the first has nothing to be tracked against
  for (int i = 1; i < 30; ++i) EXPECT_FALSE(watch.lost(sweep(i, i % 3 == 0))) << i;
  for (int i = 30; i < 60; ++i) EXPECT_FALSE(watch.lost(sweep(i, false, true))) << i;
  EXPECT_FALSE(watch.lost(sweep(61, false)));
  EXPECT_TRUE(watch.lost(sweep(62, false)));
}

TEST(LostWatch, ANewBeginningHasItsTime) {
  LostWatch watch(3);
  watch.lost(sweep(0, true));
  EXPECT_TRUE(watch.lost(sweep(4, false)));
  watch.begin_again();
  EXPECT_FALSE(watch.lost(sweep(5, false)));
  EXPECT_FALSE(watch.lost(sweep(7, false)));
  EXPECT_TRUE(watch.lost(sweep(8, false)));
}

TEST(LostWatch, CanBeSwitchedOff) {
  LostWatch watch(0);
  watch.lost(sweep(0, true));
  EXPECT_FALSE(watch.lost(sweep(1e6, false)));
}

}  // namespace
}  // namespace lxd::board_lost_watch_test
