// SPDX-License-Identifier: Apache-2.0
// Frames find the trigger that made them: over jitter, lost edges, lost frames, late edges.
#include <random>

#include <gtest/gtest.h>

#include "drivers/sync/trigger_matcher.hpp"

namespace lxd::drivers_trigger_matcher_test {
namespace {

Duration ms(double value) { return Duration::from_seconds(value * 1e-3); }
RigTime at_ms(double value) { return RigTime::from_ns(1'700'000'000 * kNanosPerSecond) + ms(value); }

// Exposure of 4 ms that begins 0.1 ms after the edge.
TriggerTiming timing() { return {.delay_min = ms(2), .delay_max = ms(45), .to_exposure = ms(0.1), .exposure = ms(4)}; }

TEST(TriggerMatcher, AFrameIsOfTheMiddleOfItsExposure) {
  TriggerMatcher matcher(timing());
  matcher.add_trigger(at_ms(0));
  const TriggerMatch match = matcher.match(at_ms(13), at_ms(14));
  EXPECT_EQ(match.verdict, TriggerVerdict::matched);
  EXPECT_EQ(match.instant, at_ms(2.1));
}

// 20 Hz, one edge in twenty and one frame in twenty-five lost, frames 12 ms behind with 1 ms of jitter.
TEST(TriggerMatcher, EveryFrameWithAnEdgeFindsItAndNoOther) {
  TriggerMatcher matcher(timing());
  std::mt19937 random(7);
  std::uniform_real_distribution<double> jitter(0, 1);
  std::uint64_t lost_edges = 0, lost_frames = 0;
  for (int i = 0; i < 2000; ++i) {
    const RigTime edge = at_ms(50 * i);
    const bool edge_lost = i % 20 == 13, frame_lost = i % 25 == 7;
    lost_edges += edge_lost && !frame_lost ? 1 : 0;
    lost_frames += frame_lost && !edge_lost ? 1 : 0;
    if (!edge_lost) matcher.add_trigger(edge);
    if (frame_lost) continue;
    const RigTime stamp = edge + ms(12) + ms(jitter(random));
    const TriggerMatch match = matcher.match(stamp, stamp + ms(200));
    ASSERT_EQ(match.verdict == TriggerVerdict::matched, !edge_lost) << i;
    EXPECT_TRUE(edge_lost || match.instant == edge + ms(2.1)) << i;
  }
  EXPECT_EQ(matcher.counts().frames_without_trigger, lost_edges);
  EXPECT_EQ(matcher.counts().triggers_without_frame, lost_frames);
  EXPECT_NEAR(matcher.delay().seconds(), 12.5e-3, 0.5e-3);
}

// The edge's event comes by USB, later than the frame.
TEST(TriggerMatcher, AFrameWaitsForAnEdgeThatComesLate) {
  TriggerMatcher matcher(timing());
  EXPECT_EQ(matcher.match(at_ms(13), at_ms(14)).verdict, TriggerVerdict::wait);
  matcher.add_trigger(at_ms(0));
  EXPECT_EQ(matcher.match(at_ms(13), at_ms(30)).verdict, TriggerVerdict::matched);
  EXPECT_EQ(matcher.match(at_ms(63), at_ms(64)).verdict, TriggerVerdict::wait);
  EXPECT_EQ(matcher.match(at_ms(63), at_ms(163)).verdict, TriggerVerdict::unmatched) << "its patience is over";
}

// Two edges within the window: which of them is not known until the delay is.
TEST(TriggerMatcher, DoesNotGuessBetweenTwoEdges) {
  TriggerMatcher matcher(timing());
  matcher.add_trigger(at_ms(0));
  matcher.add_trigger(at_ms(20));
  EXPECT_EQ(matcher.match(at_ms(33), at_ms(34)).verdict, TriggerVerdict::unmatched);
  EXPECT_EQ(matcher.counts().ambiguous, 1U);
}

TEST(TriggerMatcher, OnceTheDelayIsKnownEdgesMayBeNearerThanTheWindow) {
  TriggerMatcher matcher(timing());
  for (int i = 0; i < 10; ++i) {
    matcher.add_trigger(at_ms(100 * i));
    ASSERT_EQ(matcher.match(at_ms(100 * i + 12), at_ms(100 * i + 13)).verdict, TriggerVerdict::matched);
  }
  for (int i = 0; i < 10; ++i) matcher.add_trigger(at_ms(2000 + 20 * i));
  for (int i = 0; i < 10; ++i) {
    const TriggerMatch match = matcher.match(at_ms(2012 + 20 * i), at_ms(2300));
    EXPECT_EQ(match.verdict, TriggerVerdict::matched) << i;
    EXPECT_EQ(match.instant, at_ms(2000 + 20 * i + 2.1)) << i;
  }
}

TEST(TriggerMatcher, LeavesOutEdgesThatGoBackAndForgetsTheOldest) {
  TriggerMatcher matcher(timing());
  matcher.add_trigger(at_ms(10));
  matcher.add_trigger(at_ms(10));
  matcher.add_trigger(at_ms(5));
  EXPECT_EQ(matcher.counts().disordered, 2U);
  for (int i = 1; i <= 1000; ++i) matcher.add_trigger(at_ms(10 + i));
  EXPECT_EQ(matcher.counts().triggers_without_frame, 1001U - 64U);
}

}  // namespace
}  // namespace lxd::drivers_trigger_matcher_test
