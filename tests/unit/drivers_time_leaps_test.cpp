// SPDX-License-Identifier: Apache-2.0
// Stamps that are far too late are told from gaps and from clocks that step back.
#include <gtest/gtest.h>

#include "drivers/replay/time_leaps.hpp"

namespace lxd::drivers_time_leaps_test {
namespace {

constexpr double kNone = -1;  // a blank line

StampLines lines(const std::vector<double>& times_s) {
  StampLines stamps;
  for (const double s : times_s) stamps.push_back(s == kNone ? std::nullopt : std::optional(RigTime::from_seconds(s)));
  return stamps;
}

struct Story {
  const char* name;
  std::vector<double> times_s;
  std::vector<std::size_t> leaps;  // lines, from 0
};

class TimeLeaps : public testing::TestWithParam<Story> {};

TEST_P(TimeLeaps, AreTheLinesBehindWhichTheRecordingReturns) {
  const std::vector<bool> found = find_time_leaps(lines(GetParam().times_s));
  ASSERT_EQ(found.size(), GetParam().times_s.size());
  std::vector<std::size_t> leaps;
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (found[i]) leaps.push_back(i);
  }
  EXPECT_EQ(leaps, GetParam().leaps);
}

const Story kStories[] = {
    {"SoundTimes", {1.0, 1.1, 1.2, 1.3}, {}},
    {"LeapAtTheStart", {900, 1.1, 1.2, 1.3}, {0}},
    {"LeapInTheMiddle", {1.0, 1.1, 900, 1.3, 1.4}, {2}},
    {"LeapInTheLastLineButOne", {1.0, 1.1, 900, 1.3}, {2}},
    {"LeapInTheLastLineHarmsNothingAndMayBeAGap", {1.0, 1.1, 1.2, 900}, {}},
    {"LeapByLittleMoreThanTwoPeriods", {1.0, 1.1, 1.45, 1.3, 1.4, 1.5}, {2}},
    {"TwoLeapsApart", {1.0, 900, 1.2, 1.3, 1.4, 800, 1.6, 1.7}, {1, 5}},
    {"TwoLeapsEveryOtherLine", {1.0, 900, 1.2, 800, 1.4, 1.5}, {1, 3}},
    {"TwoLeapsInARowFalling", {1.0, 900, 800, 1.3, 1.4}, {1, 2}},
    {"SevenLeapsInARowRising", {1.0, 900, 901, 902, 903, 904, 905, 906, 1.8, 1.9}, {1, 2, 3, 4, 5, 6, 7}},
    {"LeapAmongBlankLines", {1.0, 1.1, 900, kNone, 1.4, kNone, 1.6}, {2}},
    {"TwoLateStampsAtTheStartMayBeAStep", {9.0, 9.1, 2.2, 2.3, 2.4}, {}},
    {"ClockStepsBackBySeconds", {9.0, 9.1, 9.2, 2.3, 2.4, 2.5, 2.6}, {}},
    {"ClockStepsBackByOneAndAHalfPeriods", {1.0, 1.1, 1.2, 1.15, 1.25, 1.35, 1.45}, {}},
    {"ClockStepsBackByFourPeriods", {1.0, 1.1, 1.2, 1.3, 1.0, 1.1, 1.2, 1.3, 1.4, 1.5}, {}},
    {"GapForward", {1.0, 1.1, 900, 900.1, 900.2}, {}},
    {"OneStampTooEarly", {1.0, 1.1, 0.2, 1.3, 1.4}, {}},
    {"OneStampTooEarlyAfterTheFirst", {1.0, 0.2, 1.2, 1.3}, {}},
    {"RepeatedStamp", {1.0, 1.1, 1.1, 1.2}, {}},
    {"TwoStampsThatFall", {1.0, 0.9}, {}},
    {"OneStamp", {1.0}, {}},
    {"NoStamp", {}, {}},
};

INSTANTIATE_TEST_SUITE_P(Recording, TimeLeaps, testing::ValuesIn(kStories),
                         [](const auto& story) { return story.param.name; });

TEST(FirstSoundStamp, PassesOverBlankLinesAndLeaps) {
  EXPECT_EQ(first_sound_stamp(lines({kNone, 900, 1.2, 1.3})), RigTime::from_seconds(1.2));
  EXPECT_EQ(first_sound_stamp(lines({900, 901})), RigTime::from_seconds(900));
}

}  // namespace
}  // namespace lxd::drivers_time_leaps_test
