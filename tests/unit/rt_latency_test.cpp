// SPDX-License-Identifier: Apache-2.0
// The histogram against sorted values, the stopwatch against the clock, counters by cause.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "rt/counters.hpp"
#include "rt/latency_histogram.hpp"
#include "rt/stopwatch.hpp"
#include "tests/support/property.hpp"

namespace lxd::rt_latency_test {
namespace {

Duration ns(std::int64_t value) { return Duration::from_ns(value); }

// Nearest rank, by sorting.
std::int64_t exact_quantile(std::vector<std::int64_t> values, double q) {
  std::sort(values.begin(), values.end());
  const double rank = std::ceil(q * static_cast<double>(values.size()));
  return values[std::max<std::size_t>(1, static_cast<std::size_t>(rank)) - 1];
}

TEST(LatencyHistogram, GivenNothingThenAllIsZero) {
  const LatencyHistogram histogram;
  EXPECT_EQ(histogram.count(), 0u);
  EXPECT_EQ(histogram.mean(), ns(0));
  EXPECT_EQ(histogram.p50(), ns(0));
  EXPECT_EQ(histogram.max(), ns(0));
}

TEST(LatencyHistogram, GivenOneValueThenEveryStatisticIsThatValueWithinTheStatedError) {
  for (std::int64_t value = 1; value < LatencyHistogram::kLargest_ns; value = value * 17 / 16 + 1) {
    LatencyHistogram histogram;
    histogram.add(ns(value));
    const auto found = static_cast<double>(histogram.p50().ns());
    EXPECT_NEAR(found, static_cast<double>(value), LatencyHistogram::kRelativeError * static_cast<double>(value));
    EXPECT_LE(histogram.p99(), histogram.max());
    EXPECT_EQ(histogram.max(), ns(value));
    EXPECT_EQ(histogram.mean(), ns(value));
  }
}

TEST(LatencyHistogram, QuantilesStayWithinTheStatedErrorOfTheSortedValues) {
  static_assert(LatencyHistogram::kRelativeError <= 0.02);
  test::check_property(
      [] {
        const auto size = *rc::gen::inRange<std::size_t>(1, 200);
        LatencyHistogram histogram;
        std::vector<std::int64_t> values;
        for (std::size_t i = 0; i < size; ++i) {
          values.push_back(static_cast<std::int64_t>(std::exp2(test::uniform(0, 39))));
          histogram.add(ns(values.back()));
        }
        for (const double q : {0.0, 0.25, 0.5, 0.9, 0.99, 1.0}) {
          const auto wanted = static_cast<double>(exact_quantile(values, q));
          const auto found = static_cast<double>(histogram.quantile(q).ns());
          RC_ASSERT(std::abs(found - wanted) <= LatencyHistogram::kRelativeError * wanted);
        }
      },
      100);
}

TEST(LatencyHistogram, GivenValuesOutsideItsRangeThenTheyAreKeptAtItsEnds) {
  LatencyHistogram histogram;
  histogram.add(ns(-5));
  EXPECT_EQ(histogram.p50(), ns(0));
  histogram.add(ns(LatencyHistogram::kLargest_ns * 4));
  EXPECT_EQ(histogram.max(), ns(LatencyHistogram::kLargest_ns * 4));
  EXPECT_EQ(histogram.mean(), ns(LatencyHistogram::kLargest_ns * 2));
  EXPECT_LE(histogram.p99().ns(), LatencyHistogram::kLargest_ns + 1);
}

TEST(Stopwatch, MeasuresNoLessThanASleep) {
  const Stopwatch watch;
  const timespec pause{0, 2'000'000};
  ASSERT_EQ(nanosleep(&pause, nullptr), 0);
  EXPECT_GE(watch.elapsed(), ns(2'000'000));
}

TEST(Stopwatch, LapsAddUpToTheWhole) {
  const Duration begin = Stopwatch::now();
  Stopwatch watch;
  Duration sum;
  for (int i = 0; i < 100; ++i) sum = sum + watch.lap();
  EXPECT_LE(sum, Stopwatch::now() - begin);
  EXPECT_GE(sum, ns(0));
}

TEST(Counters, CountEachCauseByItself) {
  enum class Drop { kRingFull, kPoolEmpty, kCount };
  Counters<Drop> drops;
  drops.add(Drop::kPoolEmpty);
  drops.add(Drop::kPoolEmpty, 4);
  EXPECT_EQ(drops[Drop::kRingFull], 0u);
  EXPECT_EQ(drops[Drop::kPoolEmpty], 5u);
  EXPECT_EQ(drops.total(), 5u);
}

}  // namespace
}  // namespace lxd::rt_latency_test
