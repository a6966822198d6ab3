// SPDX-License-Identifier: Apache-2.0
// Pools lend each element once, refuse when empty, detect a double release, and remember how far they were used.
#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <optional>
#include <set>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "rt/arena.hpp"
#include "rt/fixed_pool.hpp"
#include "rt/spsc_ring.hpp"
#include "rt/sweep_pool.hpp"
#include "tests/support/property.hpp"

namespace lxd::rt_pool_test {
namespace {

struct Memory {
  alignas(Arena::kAlignment) std::array<std::byte, 1 << 16> block{};
  Arena arena{block};
};

// Debug builds stop at a misuse; release builds count it.
#ifdef NDEBUG
#define EXPECT_MISUSE(call) EXPECT_FALSE(call)
constexpr std::uint64_t kMisuseCounted = 1;
#else
#define EXPECT_MISUSE(call) EXPECT_DEATH((void)(call), "not lent|RealtimeSanitizer")  // the latter stops assert itself
constexpr std::uint64_t kMisuseCounted = 0;  // in the process that died
#endif

TEST(FixedPool, GivenAllLentWhenAcquiredThenItRefusesAndCounts) {
  Memory memory;
  FixedPool<int> pool(memory.arena, "cells", 3);
  for (int i = 0; i < 3; ++i) EXPECT_TRUE(pool.acquire().has_value());
  EXPECT_EQ(pool.acquire(), std::nullopt);
  EXPECT_EQ(pool.refused(), 1u);
  EXPECT_EQ(pool.high_water(), 3u);
}

TEST(FixedPool, GivenADoubleReleaseThenItIsDetectedAndTheFreeListSurvives) {
  Memory memory;
  FixedPool<int> pool(memory.arena, "cells", 2);
  const auto a = pool.acquire(), b = pool.acquire();
  ASSERT_TRUE(a && b);
  EXPECT_TRUE(pool.release(*a));
  EXPECT_MISUSE(pool.release(*a));
  EXPECT_EQ(pool.misused(), kMisuseCounted);
  EXPECT_EQ(pool.lent(), 1u);
  EXPECT_EQ(pool.acquire(), a);
  EXPECT_EQ(pool.acquire(), std::nullopt) << "b must not be lent twice";
}

TEST(FixedPool, GivenAnIndexOutsideThePoolWhenReleasedThenItIsDetected) {
  Memory memory;
  FixedPool<int> pool(memory.arena, "cells", 2);
  EXPECT_MISUSE(pool.release(2));
  EXPECT_EQ(pool.misused(), kMisuseCounted);
}

TEST(FixedPool, GivenAnArenaThatIsTooSmallThenThePoolIsEmptyAndTheArenaSaysHowMuchItWanted) {
  Memory memory;
  FixedPool<std::array<std::byte, 1024>> pool(memory.arena, "cells", 64);
  EXPECT_TRUE(memory.arena.exhausted());
  EXPECT_EQ(pool.capacity(), 0u);
  EXPECT_EQ(pool.acquire(), std::nullopt);
}

TEST(FixedPool, LendsEachElementToOneUserAtATime) {
  test::check_property([](const std::vector<std::uint8_t>& commands) {
    Memory memory;
    FixedPool<int> pool(memory.arena, "cells", 5);
    std::set<std::uint32_t> lent;
    std::size_t high_water = 0;
    for (const std::uint8_t command : commands) {
      if (command % 2 == 0) {
        const auto index = pool.acquire();
        RC_ASSERT(index.has_value() == (lent.size() < 5));
        if (index) RC_ASSERT(lent.insert(*index).second);
      } else if (!lent.empty()) {
        const std::uint32_t index = *std::next(lent.begin(), command % lent.size());
        RC_ASSERT(pool.is_lent(index) && pool.release(index) && !pool.is_lent(index));
        lent.erase(index);
      }
      high_water = std::max(high_water, lent.size());
      RC_ASSERT(pool.lent() == lent.size() && pool.high_water() == high_water);
    }
  });
}

TEST(SweepPool, LendsEmptySweepsWithTheirOwnStorage) {
  Memory memory;
  SweepPool pool(memory.arena, "sweeps", 3, 100);
  const auto a = pool.acquire(), b = pool.acquire();
  ASSERT_TRUE(a && b);
  EXPECT_EQ(pool[*a].storage.size(), 100u);
  EXPECT_NE(pool[*a].storage.data(), pool[*b].storage.data());
  EXPECT_EQ(pool.lent(), 2u);
  EXPECT_EQ(pool.high_water(), 2u);
}

TEST(SweepPool, GivenAUsedSweepWhenLentAgainThenItIsEmptyAndKeepsItsStorage) {
  Memory memory;
  SweepPool pool(memory.arena, "sweeps", 1, 10);
  const auto first = pool.acquire();
  ASSERT_TRUE(first);
  const LidarPoint* const points = pool[*first].storage.data();
  ASSERT_TRUE(pool[*first].push({1, 2, 3, 4, 5}));
  pool[*first].sequence = 9;
  ASSERT_TRUE(pool.release(*first));
  const auto again = pool.acquire();
  ASSERT_TRUE(again);
  EXPECT_EQ(pool[*again].count, 0u);
  EXPECT_EQ(pool[*again].sequence, 0u);
  EXPECT_EQ(pool[*again].storage.data(), points);
}

TEST(SweepPool, GivenAllLentThenItRefusesAndADoubleReleaseIsDetected) {
  Memory memory;
  SweepPool pool(memory.arena, "sweeps", 2, 10);
  const auto a = pool.acquire(), b = pool.acquire();
  ASSERT_TRUE(a && b);
  EXPECT_EQ(pool.acquire(), std::nullopt);
  EXPECT_TRUE(pool.release(*b));
  EXPECT_MISUSE(pool.release(*b));
  EXPECT_MISUSE(pool.release(17));
  EXPECT_EQ(pool.misused(), 2 * kMisuseCounted);
  EXPECT_EQ(pool.lent(), 1u);
}

TEST(SweepPool, GivenAnArenaThatIsTooSmallThenThePoolIsEmpty) {
  Memory memory;
  SweepPool pool(memory.arena, "sweeps", 3, 100'000);
  EXPECT_TRUE(memory.arena.exhausted());
  EXPECT_EQ(pool.capacity(), 0u);
  EXPECT_EQ(pool.acquire(), std::nullopt);
}

// A driver's thread fills sweeps and hands their indices over; this thread reads the points in place.
TEST(SweepPool, GivenADriverAndAnEstimatorThreadThenEveryPointArrivesWithoutACopy) {
  constexpr std::uint32_t kSweeps = 20'000;
  constexpr std::uint32_t kPoints = 16;
  Memory memory;
  SweepPool pool(memory.arena, "sweeps", 4, kPoints);
  SpscRing<SweepIndex> ring(memory.arena.take<SweepIndex>("ring", 4));

  std::thread driver([&] {
    for (std::uint32_t sequence = 0; sequence < kSweeps; ++sequence) {
      std::optional<SweepIndex> index;
      while (!(index = pool.acquire())) std::this_thread::yield();
      pool[*index].sequence = sequence;
      while (pool[*index].push({0, 0, 0, 0, sequence})) {
      }
      while (!ring.push(*index)) std::this_thread::yield();
    }
  });
  std::uint32_t wrong = 0;
  for (std::uint32_t sequence = 0; sequence < kSweeps;) {
    const std::optional<SweepIndex> index = ring.pop();
    if (!index) {
      std::this_thread::yield();
      continue;
    }
    wrong += pool[*index].sequence != sequence || pool[*index].count != kPoints ? 1 : 0;
    for (const LidarPoint& point : pool[*index].points()) wrong += point.offset_ns != sequence ? 1 : 0;
    wrong += pool.release(*index) ? 0 : 1;
    ++sequence;
  }
  driver.join();

  EXPECT_EQ(wrong, 0u);
  EXPECT_EQ(pool.lent(), 0u);
  EXPECT_LE(pool.high_water(), 4u);
}

}  // namespace
}  // namespace lxd::rt_pool_test
