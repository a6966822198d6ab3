// SPDX-License-Identifier: Apache-2.0
// Loops by sight: places are known again by what they look like and by where they are, other places are not, and work
// and memory stay within their bounds.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/support/sight_walk.hpp"

namespace lxd::backend_sight_finder_test {
namespace {

using test::SightWalk;

constexpr unsigned kFar = 20;  // places that are passed before one is seen again: 200 m

double error_m(const LoopMeasurement& loop, unsigned place) {
  return (loop.T_from_to.p - SightWalk::true_loop(place).p).norm();
}

TEST(SightFinder, FindsAPlaceThatIsSeenAgain) {
  SightWalk walk;
  walk.pass_some(0, kFar);
  const auto loop = walk.return_to(3);
  ASSERT_TRUE(loop);
  EXPECT_EQ(loop->from, 3);
  EXPECT_EQ(loop->to, kFar);
  EXPECT_EQ(loop->by, LoopSense::sight);
  EXPECT_LT(error_m(*loop, 3), 0.2);
}

// Given poses that are off by more than what counts as near, then the looks alone lead there.
TEST(SightFinder, FindsItByItsLooksWhenTheFilterHasDrifted) {
  SightWalk walk;
  walk.pass_some(0, kFar);
  const auto loop = walk.return_to(3, {0, 9, 0});
  ASSERT_TRUE(loop);
  EXPECT_EQ(loop->from, 3);
  EXPECT_LT(error_m(*loop, 3), 0.2);
}

TEST(SightFinder, OtherPlacesAreNotTakenForIt) {
  SightWalk walk;
  walk.pass_some(0, kFar);
  // A scene that was never seen, where another one was
  const test::SightScene other({}, 1000);
  EXPECT_FALSE(walk.look(other.current, SightWalk::pose_of(3)));
  EXPECT_GT(walk.finder.counters().candidates, 0U) << "the nearest by the poses is looked at all the same";
  EXPECT_EQ(walk.finder.counters().verdicts[0], 0U);
}

// It looks the same, and is where the odometry cannot have come from.
TEST(SightFinder, ALookAlikeThatIsFarOffIsNone) {
  SightWalk walk;
  walk.pass_some(0, kFar);
  EXPECT_FALSE(walk.return_to(3, {0, 80, 0}));
}

TEST(SightFinder, WhatTheFilterStillRegistersAgainstClosesNothing) {
  SightWalk walk;
  walk.pass_some(0, 4);
  EXPECT_FALSE(walk.return_to(3));
  EXPECT_EQ(walk.finder.counters().candidates, 0U);
}

TEST(SightFinder, AfterALoopTheNextIsSoughtSomeWayOn) {
  SightFinderConfig config;
  config.loop_spacing_m = 15;
  SightWalk walk(config);
  walk.pass_some(0, kFar);
  EXPECT_TRUE(walk.return_to(3));
  EXPECT_FALSE(walk.return_to(4)) << "10 m behind";
  EXPECT_TRUE(walk.return_to(5));
  EXPECT_EQ(walk.finder.counters().asked, kFar + 2);
}

TEST(SightFinder, AKeyFrameWithoutFeaturesIsNoPlace) {
  SightWalk walk;
  EXPECT_FALSE(walk.look({}, Pose()));
  EXPECT_EQ(walk.finder.counters().poor, 1U);
  EXPECT_EQ(walk.finder.counters().asked, 0U);
}

// Given a filter that began again, so that poses say nothing, then the path before is known by its looks.
TEST(SightFinder, FindsWhatCameBeforeTheFilterBeganAgain) {
  SightWalk walk;
  walk.pass_some(0, kFar);
  walk.finder.begin_again();
  const auto loop = walk.return_to(3, {500, 0, 0});
  ASSERT_TRUE(loop);
  EXPECT_EQ(loop->from, 3);
  EXPECT_LT(error_m(*loop, 3), 0.2);
}

// Given places that all look like each other, a storm of candidates, then no more are verified than a key frame may.
TEST(SightFinder, AStormOfLookAlikesIsBounded) {
  SightFinderConfig config;
  config.loop_spacing_m = 0;
  config.pnp.inliers_min = 10'000;  // so that every candidate has to be looked at
  SightFinder finder(config);
  const VisualKeyFrame same = test::SightScene({}, 1).historical;
  for (int i = 0; i < 200; ++i) finder.look(same, {Pose(), SightWalk::kStep_m * i, i / 4});
  const SightCounters& counters = finder.counters();
  EXPECT_GT(counters.candidates, 100U);
  EXPECT_LE(counters.candidates, (1 + config.by_looks) * counters.asked);
}

TEST(SightFinder, MemoryIsBoundedAndTheOldestIsThinned) {
  SightFinderConfig config;
  config.memory = {.frames_max = 60, .features_max = 40};
  const std::size_t bound = config.memory.frames_max *
                                (sizeof(SightedPlace) + config.memory.features_max *
                                                            (sizeof(VisualFeature) +
                                                             DescriptorIndex::kTables * DescriptorIndex::kEntryBytes)) +
                            DescriptorIndex::kHeadBytes;
  SightWalk walk(config);
  for (unsigned i = 0; i < 300; ++i) {
    walk.pass(i % 80);
    ASSERT_LE(walk.finder.bytes(), bound) << i;
  }
  EXPECT_GT(walk.finder.counters().forgotten, 200U);
}

TEST(SightFinder, AThinnedMemoryStillKnowsItsPlaces) {
  SightFinderConfig config;
  config.memory.frames_max = 30;
  SightWalk walk(config);
  walk.pass_some(0, 40);
  EXPECT_GT(walk.finder.counters().forgotten, 0U);
  EXPECT_TRUE(walk.return_to(24)) << "of the younger half";
  EXPECT_TRUE(walk.return_to(0) || walk.return_to(1)) << "one of two neighbours stays";
}

TEST(SightFinder, SaysTheSameTwice) {
  SightWalk one, two;
  for (SightWalk* const walk : {&one, &two}) walk->pass_some(0, kFar);
  const auto a = one.return_to(3), b = two.return_to(3);
  ASSERT_TRUE(a && b);
  EXPECT_EQ(a->T_from_to.p, b->T_from_to.p);
  EXPECT_EQ(a->covariance, b->covariance);
}

// Given key frames that look unlike, then most votes are for the one that is seen again.
TEST(DescriptorIndex, VotesAreForWhatLooksAlike) {
  DescriptorIndex index;
  constexpr unsigned kPlaces = 30;
  for (unsigned i = 0; i < kPlaces; ++i) index.add(i, test::SightScene({}, i).historical.features);
  for (unsigned i = 0; i < kPlaces; ++i) {
    const auto votes = index.votes(test::SightScene({}, i).current.features, kPlaces);
    EXPECT_EQ(std::ranges::max_element(votes) - votes.begin(), i);
  }
}

TEST(DescriptorIndex, AnEmptyOneVotesForNobody) {
  const DescriptorIndex index;
  EXPECT_EQ(index.votes(test::SightScene({}, 1).current.features, 2), std::vector<float>(2, 0.0F));
  EXPECT_EQ(index.bytes(), 0U);
}

}  // namespace
}  // namespace lxd::backend_sight_finder_test
