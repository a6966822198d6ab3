// SPDX-License-Identifier: Apache-2.0
// The IMU's newest readings: the spans between two times, what counts as covered, and which readings are left out.
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "estimator/imu_history.hpp"
#include "tests/support/mapping_scene.hpp"

namespace lxd::estimator_imu_history_test {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kMillisecond = 1'000'000;
constexpr Duration kGapMax = Duration::from_ns(30 * kMillisecond);

RigTime at_ms(double ms) { return RigTime::from_ns(std::llround(ms * 1e6)); }

// Values that grow with time, so that the mean over any span is that of its middle.
InertialReading growing(double ms) { return {at_ms(ms), Vector3d(ms, 2 * ms, -ms), Vector3d(0, 1, ms)}; }

class EstimatorImuHistory : public testing::Test {
 protected:
  void fill(double from_ms, double to_ms, double step_ms = 10) {
    for (double ms = from_ms; ms <= to_ms; ms += step_ms) history_.add(growing(ms));
  }
  test::OwnedArena arena_{std::size_t{1} << 20};
  ImuHistory history_{*arena_};
};

TEST_F(EstimatorImuHistory, SpansAddUpToTheTimeBetweenWhereverItBegins) {
  fill(0, 200);
  for (const auto& [from, to] : {std::pair{20.0, 120.0}, {23.0, 117.0}, {23.0, 26.0}, {20.0, 30.0}, {199.0, 215.0}}) {
    double sum_s = 0;
    for (const InertialSpan& span : history_.spans(at_ms(from), at_ms(to))) {
      EXPECT_GT(span.span_s, 0);
      sum_s += span.span_s;
    }
    EXPECT_NEAR(sum_s, (to - from) * 1e-3, 1e-12) << from;
  }
  EXPECT_TRUE(history_.spans(at_ms(50), at_ms(50)).empty());
}

TEST_F(EstimatorImuHistory, EachSpanIsTheMeanOfItsEndsWhichAreInterpolated) {
  fill(0, 200);
  const auto spans = history_.spans(at_ms(23), at_ms(47));
  ASSERT_EQ(spans.size(), 3U);  // 23..30, 30..40, 40..47
  const double middles[] = {26.5, 35, 43.5};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_LT((spans[i].rate_radps - growing(middles[i]).rate_radps).norm(), 1e-9) << i;
    EXPECT_LT((spans[i].force_mps2 - growing(middles[i]).force_mps2).norm(), 1e-9) << i;
  }
}

TEST_F(EstimatorImuHistory, AfterTheLastReadingItsValuesAreHeld) {
  fill(0, 100);
  const auto spans = history_.spans(at_ms(100), at_ms(120));
  ASSERT_EQ(spans.size(), 1U);
  EXPECT_EQ(spans[0].rate_radps, growing(100).rate_radps);
}

TEST_F(EstimatorImuHistory, CoversWhatLiesBetweenItsReadingsAndALittleAfter) {
  EXPECT_FALSE(history_.covers(at_ms(10), at_ms(20), kGapMax));  // there are none
  fill(50, 150);
  EXPECT_FALSE(history_.covers(at_ms(49.9), at_ms(100), kGapMax));
  EXPECT_TRUE(history_.covers(at_ms(50), at_ms(150), kGapMax));
  EXPECT_TRUE(history_.covers(at_ms(60), at_ms(179.9), kGapMax));
  EXPECT_TRUE(history_.covers(at_ms(60), at_ms(180), kGapMax));
  EXPECT_FALSE(history_.covers(at_ms(60), at_ms(180.1), kGapMax));
}

TEST_F(EstimatorImuHistory, AGapBelowAndAtTheLimitIsCoveredAndOneAboveIsNot) {
  for (const auto& [gap_ms, covered] : {std::pair{29.0, true}, {30.0, true}, {30.1, false}, {500.0, false}}) {
    ImuHistory history(*arena_);
    history.add(growing(0));
    history.add(growing(10));
    history.add(growing(10 + gap_ms));
    history.add(growing(20 + gap_ms));
    // The gap lies within, across the begin and across the end.
    EXPECT_EQ(history.covers(at_ms(5), at_ms(15 + gap_ms), kGapMax), covered) << gap_ms;
    EXPECT_EQ(history.covers(at_ms(10 + gap_ms / 2), at_ms(15 + gap_ms), kGapMax), covered) << gap_ms;
    EXPECT_EQ(history.covers(at_ms(5), at_ms(10 + gap_ms / 2), kGapMax), covered) << gap_ms;
    EXPECT_TRUE(history.covers(at_ms(10 + gap_ms), at_ms(20 + gap_ms), kGapMax)) << gap_ms;
  }
}

TEST_F(EstimatorImuHistory, ItKeepsTheNewestWhenItIsFull) {
  for (std::uint32_t i = 0; i < ImuHistory::kReadings + 500; ++i) history_.add(growing(0.5 * i));
  EXPECT_EQ(history_.size(), ImuHistory::kReadings);
  const double newest_ms = 0.5 * (ImuHistory::kReadings + 499);
  EXPECT_EQ(history_.newest().t, at_ms(newest_ms));
  EXPECT_FALSE(history_.covers(at_ms(249.5), at_ms(260), kGapMax));  // forgotten
  EXPECT_TRUE(history_.covers(at_ms(250), at_ms(260), kGapMax));
  const auto spans = history_.spans(at_ms(newest_ms - 100), at_ms(newest_ms));
  EXPECT_EQ(spans.size(), 200U);
  EXPECT_LT((spans.back().rate_radps - growing(newest_ms - 0.25).rate_radps).norm(), 1e-9);
}

TEST_F(EstimatorImuHistory, MoreReadingsThanItHasSpansForAreNotCovered) {
  for (std::uint32_t i = 0; i < ImuHistory::kReadings; ++i) history_.add(growing(0.5 * i));
  const auto covers = [&](std::uint32_t readings) {
    return history_.covers(at_ms(0.25), at_ms(0.25 + 0.5 * readings), kGapMax);
  };
  EXPECT_TRUE(covers(ImuHistory::kSpansMax - 2));
  EXPECT_FALSE(covers(ImuHistory::kSpansMax - 1));
  const RigTime to = at_ms(0.25 + 0.5 * (ImuHistory::kSpansMax - 2));
  double sum_s = 0;
  for (const InertialSpan& span : history_.spans(at_ms(0.25), to)) sum_s += span.span_s;
  EXPECT_NEAR(sum_s, (to - at_ms(0.25)).seconds(), 1e-12);
}

TEST_F(EstimatorImuHistory, ReadingsThatAreLateOrNoNumbersAreCountedAndLeftOut) {
  fill(0, 50);
  InertialReading bad = growing(60);
  bad.rate_radps.y() = std::numeric_limits<double>::quiet_NaN();
  history_.add(bad);
  bad = growing(60);
  bad.force_mps2.z() = -std::numeric_limits<double>::infinity();
  history_.add(bad);
  history_.add(growing(50));  // again
  history_.add(growing(33));
  EXPECT_EQ(history_.counts().not_finite, 2U);
  EXPECT_EQ(history_.counts().late, 2U);
  EXPECT_EQ(history_.counts().stuck, 0U);
  EXPECT_EQ(history_.size(), 6U);
  EXPECT_EQ(history_.newest().t, at_ms(50));
}

TEST_F(EstimatorImuHistory, ASensorThatHangsIsFoundOutAndTakenAgainWhenItChanges) {
  const auto same = [&](double ms) { history_.add({at_ms(ms), Vector3d(1, 2, 3), Vector3d(0, 0, 9.8)}); };
  double ms = 0;
  for (std::uint32_t i = 0; i < ImuHistory::kStuckReadings; ++i) same(ms += 10);
  EXPECT_EQ(history_.counts().stuck, 0U);
  EXPECT_EQ(history_.size(), ImuHistory::kStuckReadings);
  for (int i = 0; i < 10; ++i) same(ms += 10);
  EXPECT_EQ(history_.counts().stuck, 10U);
  EXPECT_EQ(history_.size(), ImuHistory::kStuckReadings);
  EXPECT_FALSE(history_.covers(at_ms(ms - 80), at_ms(ms), kGapMax));
  history_.add(growing(ms += 10));
  EXPECT_EQ(history_.size(), ImuHistory::kStuckReadings + 1);
  EXPECT_EQ(history_.counts().stuck, 10U);
}

TEST_F(EstimatorImuHistory, TheMeanIsOfTheReadingsWithinBothEndsIncluded) {
  fill(0, 200);
  const ImuHistory::Mean mean = history_.mean(at_ms(50), at_ms(70));
  EXPECT_EQ(mean.count, 3U);
  EXPECT_LT((mean.rate_radps - growing(60).rate_radps).norm(), 1e-12);
  // Deviations 10, 0, 10 along x and z, 20 along y: the mean square of an axis is 2 * 600 / 9.
  EXPECT_NEAR(mean.rate_sigma, std::sqrt(2 * 600 / 9.0), 1e-9);
  EXPECT_NEAR(mean.force_sigma, std::sqrt(2 * 100 / 9.0), 1e-9);
  EXPECT_EQ(history_.mean(at_ms(0), at_ms(20)).count, 3U);
  EXPECT_EQ(history_.mean(at_ms(51), at_ms(59)).count, 0U);
  EXPECT_EQ(history_.mean(at_ms(300), at_ms(400)).count, 0U);
}

TEST_F(EstimatorImuHistory, ClearedItCoversNothing) {
  fill(0, 200);
  history_.clear();
  EXPECT_EQ(history_.size(), 0U);
  EXPECT_FALSE(history_.covers(at_ms(50), at_ms(100), kGapMax));
  history_.add(growing(10));  // earlier than before: not late
  EXPECT_EQ(history_.counts().late, 0U);
}

}  // namespace
}  // namespace lxd::estimator_imu_history_test
