// SPDX-License-Identifier: Apache-2.0
// The refusing ring: first in first out against a model, at its limits, and between two threads.
#include <array>
#include <cstdint>
#include <deque>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "rt/spsc_ring.hpp"
#include "tests/support/property.hpp"

namespace lxd::rt_spsc_ring_test {
namespace {

TEST(SpscRing, GivenAFullRingThenPushRefusesAndKeepsWhatItHas) {
  std::array<int, 4> storage{};
  SpscRing<int> ring(storage);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(ring.push(i));
  EXPECT_FALSE(ring.push(4));
  EXPECT_EQ(ring.size(), 4u);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(ring.pop(), i);
  EXPECT_EQ(ring.pop(), std::nullopt);
  EXPECT_TRUE(ring.empty());
}

TEST(SpscRing, GivenStorageThatIsNoPowerOfTwoThenTheLargestThatFitsIsUsed) {
  std::array<int, 7> storage{};
  EXPECT_EQ(SpscRing<int>(storage).capacity(), 4u);
}

TEST(SpscRing, GivenNoStorageThenEverythingIsRefused) {
  SpscRing<int> ring({});
  EXPECT_FALSE(ring.push(1));
  EXPECT_EQ(ring.pop(), std::nullopt);
  EXPECT_EQ(ring.front(), nullptr);
  EXPECT_EQ(ring.capacity(), 0u);
}

TEST(SpscRing, FrontShowsTheOldestWithoutTakingIt) {
  std::array<int, 2> storage{};
  SpscRing<int> ring(storage);
  ASSERT_TRUE(ring.push(7) && ring.push(8));
  ASSERT_NE(ring.front(), nullptr);
  EXPECT_EQ(*ring.front(), 7);
  ring.drop_front();
  EXPECT_EQ(*ring.front(), 8);
  ring.drop_front();
  ring.drop_front();  // of an empty ring: nothing
  EXPECT_EQ(ring.size(), 0u);
}

TEST(SpscRing, BehavesAsABoundedDeque) {
  test::check_property([](const std::vector<std::uint8_t>& commands) {
    std::array<std::uint8_t, 8> storage{};
    SpscRing<std::uint8_t> ring(storage);
    std::deque<std::uint8_t> model;
    std::size_t high_water = 0;
    for (const std::uint8_t command : commands) {
      if (command % 3 != 0) {
        const bool room = model.size() < storage.size();
        RC_ASSERT(ring.push(command) == room);
        if (room) model.push_back(command);
      } else {
        RC_ASSERT(ring.pop() == (model.empty() ? std::nullopt : std::optional(model.front())));
        if (!model.empty()) model.pop_front();
      }
      high_water = std::max(high_water, model.size());
      RC_ASSERT(ring.size() == model.size());
      RC_ASSERT(ring.high_water() == high_water);
    }
  });
}

TEST(SpscRing, GivenTwoThreadsThenEveryElementArrivesOnceAndInOrder) {
  struct Sample {
    std::uint64_t number = 0;
    std::uint64_t complement = 0;
  };
  constexpr std::uint64_t kElements = 300'000;
  std::array<Sample, 64> storage{};
  SpscRing<Sample> ring(storage);

  std::thread producer([&] {
    for (std::uint64_t i = 0; i < kElements; ++i)
      while (!ring.push({i, ~i})) std::this_thread::yield();
  });
  std::uint64_t wrong = 0;
  for (std::uint64_t i = 0; i < kElements;) {
    const std::optional<Sample> sample = ring.pop();
    if (!sample) {
      std::this_thread::yield();
      continue;
    }
    wrong += sample->number != i || sample->complement != ~i ? 1 : 0;
    ++i;
  }
  producer.join();

  EXPECT_EQ(wrong, 0u);
  EXPECT_TRUE(ring.empty());
  EXPECT_GE(ring.high_water(), 1u);
  EXPECT_LE(ring.high_water(), storage.size());
}

}  // namespace
}  // namespace lxd::rt_spsc_ring_test
