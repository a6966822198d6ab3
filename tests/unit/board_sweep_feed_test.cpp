// SPDX-License-Identifier: Apache-2.0
// Sweeps reach the estimator in order and complete, read in turn or ahead; only a paced feed passes sweeps over.
#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "board/sweep_feed.hpp"

namespace lxd::board_sweep_feed_test {
namespace {

constexpr Duration kPeriod = Duration::from_ns(10'000'000);

// So many empty sweeps, numbered, then the end or an error.
class CountingSource final : public SweepSource {
 public:
  explicit CountingSource(std::uint32_t sweeps, bool breaks = false, Duration period = kPeriod)
      : sweeps_(sweeps), breaks_(breaks), period_(period) {}

  Result<bool> next(Sweep& sweep) override {
    if (read_ == sweeps_) return breaks_ ? Result<bool>(Error{"recording: broken"}) : Result<bool>(false);
    sweep.sequence = read_;
    sweep.end = RigTime::from_ns(0) + period_ * read_;
    ++read_;
    return true;
  }
  [[nodiscard]] std::optional<std::uint64_t> size() const override { return sweeps_; }
  [[nodiscard]] std::string kind() const override { return "counting"; }
  [[nodiscard]] LidarTraits traits() const override { return {}; }
  [[nodiscard]] const std::map<std::string, std::uint64_t>& rejected() const override { return rejected_; }

 private:
  std::uint32_t sweeps_, read_ = 0;
  bool breaks_;
  Duration period_;
  std::map<std::string, std::uint64_t> rejected_;
};

class BoardSweepFeed : public testing::Test {
 protected:
  std::vector<std::uint32_t> drain(SweepFeed& feed, std::chrono::milliseconds work = {}) {
    std::vector<std::uint32_t> numbers;
    while (const auto index = feed.next()) {
      numbers.push_back(pool_[*index].sequence);
      if (work.count() > 0) std::this_thread::sleep_for(work);
      feed.give_back(*index);
    }
    return numbers;
  }

  alignas(Arena::kAlignment) std::array<std::byte, 1 << 16> block_{};
  Arena arena_{block_};
  SweepPool pool_{arena_, "sweeps", 4, 8};
  std::atomic<bool> stop_{false};
};

bool counts_up(const std::vector<std::uint32_t>& numbers, std::size_t size) {
  if (numbers.size() != size) return false;
  for (std::size_t i = 0; i < size; ++i) {
    if (numbers[i] != i) return false;
  }
  return true;
}

TEST_F(BoardSweepFeed, DirectGivesEverySweepInOrder) {
  CountingSource source(20);
  DirectFeed feed(source, pool_);
  EXPECT_TRUE(counts_up(drain(feed), 20));
  EXPECT_TRUE(feed.status());
  EXPECT_EQ(pool_.lent(), 0U);
}

TEST_F(BoardSweepFeed, ThreadsAheadGivesEverySweepInOrderHoweverSlowTheEstimator) {
  for (const int work_ms : {0, 1}) {
    CountingSource source(200);
    SweepPool pool(arena_, "more sweeps", 4, 8);
    AheadFeed feed(source, pool, false, stop_);
    std::vector<std::uint32_t> numbers;
    while (const auto index = feed.next()) {
      numbers.push_back(pool[*index].sequence);
      if (work_ms > 0) std::this_thread::sleep_for(std::chrono::milliseconds(work_ms));
      feed.give_back(*index);
    }
    EXPECT_TRUE(counts_up(numbers, 200));
    EXPECT_EQ(feed.late(), 0U);
    EXPECT_TRUE(feed.status());
  }
}

TEST_F(BoardSweepFeed, DirectTellsWhyNothingMoreCanBeRead) {
  CountingSource source(3, true);
  DirectFeed feed(source, pool_);
  EXPECT_TRUE(counts_up(drain(feed), 3));
  ASSERT_FALSE(feed.status());
  EXPECT_EQ(feed.status().error().message, "recording: broken");
}

TEST_F(BoardSweepFeed, ThreadsAheadTellsWhyAfterTheLastGoodSweep) {
  CountingSource source(3, true);
  AheadFeed feed(source, pool_, false, stop_);
  EXPECT_TRUE(counts_up(drain(feed), 3));
  EXPECT_FALSE(feed.status());
  EXPECT_FALSE(feed.next().has_value()) << "the end stays the end";
}

TEST_F(BoardSweepFeed, ThreadsAheadMayBeLeftInTheMiddle) {
  CountingSource source(1000);
  {
    AheadFeed feed(source, pool_, false, stop_);
    const auto index = feed.next();
    ASSERT_TRUE(index.has_value());
    feed.give_back(*index);
  }
  EXPECT_EQ(pool_.lent(), 0U);
}

// Given a recording whose second sweep is due in days, when the run is stopped meanwhile, then nobody waits for it.
TEST_F(BoardSweepFeed, ThreadsPacedEndsWhenStoppedWithinAGap) {
  CountingSource source(2, false, Duration::from_ns(std::int64_t{1'000'000} * kNanosPerSecond));
  AheadFeed feed(source, pool_, true, stop_);
  const auto first = feed.next();
  ASSERT_TRUE(first.has_value());
  feed.give_back(*first);
  stop_ = true;
  EXPECT_FALSE(feed.next().has_value());
}

// A recording played once more needs all buffers again.
TEST_F(BoardSweepFeed, ThreadsAheadLeavesNoBufferLentAtTheEnd) {
  CountingSource source(20);
  {
    AheadFeed feed(source, pool_, false, stop_);
    EXPECT_TRUE(counts_up(drain(feed), 20));
  }
  EXPECT_EQ(pool_.lent(), 0U);
}

// Given an estimator three times too slow for the recording's pace, when it is paced, then the newest sweep wins, and
// taken and passed-over sweeps add up to all.
TEST_F(BoardSweepFeed, ThreadsPacedPassesOverWhatIsLateAndCountsIt) {
  CountingSource source(30);
  AheadFeed feed(source, pool_, true, stop_);
  const auto numbers = drain(feed, std::chrono::milliseconds(30));
  EXPECT_EQ(numbers.size() + feed.late(), 30U);
  EXPECT_GT(feed.late(), 0U);
  EXPECT_TRUE(std::ranges::is_sorted(numbers));
}

}  // namespace
}  // namespace lxd::board_sweep_feed_test
