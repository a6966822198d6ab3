// SPDX-License-Identifier: Apache-2.0
// The ring in which the newest data wins: what it keeps, what it counts as lost, and that a copy is never torn.
#include <array>
#include <atomic>
#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include "rt/atomic_record.hpp"
#include "rt/spsc_drop_oldest_ring.hpp"
#include "tests/support/property.hpp"

namespace lxd::rt_drop_oldest_ring_test {
namespace {

using IntRing = SpscDropOldestRing<int>;

TEST(AtomicRecord, GivesOnlyTheValueThatWasStoredAsTheNumberAskedFor) {
  AtomicRecord<std::array<char, 13>> record;  // not a whole number of words
  const std::array<char, 13> text{'a', 'b', 'c', 'd', 'e', 'f', 'g', 'h', 'i', 'j', 'k', 'l', 'm'};
  std::array<char, 13> found{};
  EXPECT_FALSE(record.load(0, found));
  record.store(0, text);
  EXPECT_TRUE(record.load(0, found));
  EXPECT_EQ(found, text);
  record.store(5, {});
  EXPECT_FALSE(record.load(0, found));
  EXPECT_EQ(found, text) << "a failed load must leave the value alone";
  EXPECT_TRUE(record.load(5, found));
}

TEST(SpscDropOldestRing, GivenAFullRingWhenPushedThenTheOldestGoesAndIsCounted) {
  std::array<IntRing::Slot, 4> storage;
  IntRing ring(storage);
  for (int i = 0; i < 10; ++i) ring.push(i);
  EXPECT_EQ(ring.dropped(), 6u) << "known before the consumer looks";
  EXPECT_EQ(ring.size(), 4u);
  for (int i = 6; i < 10; ++i) EXPECT_EQ(ring.pop(), i);
  EXPECT_EQ(ring.pop(), std::nullopt);
  EXPECT_EQ(ring.dropped(), 6u);
  EXPECT_EQ(ring.high_water(), 4u);
}

TEST(SpscDropOldestRing, GivenOneSlotThenItHoldsTheNewest) {
  std::array<IntRing::Slot, 1> storage;
  IntRing ring(storage);
  ring.push(1);
  ring.push(2);
  EXPECT_EQ(ring.pop(), 2);
  EXPECT_EQ(ring.pop(), std::nullopt);
  EXPECT_EQ(ring.dropped(), 1u);
}

TEST(SpscDropOldestRing, GivenNoStorageThenEverythingIsDroppedAndCounted) {
  IntRing ring({});
  ring.push(1);
  ring.push(2);
  EXPECT_EQ(ring.pop(), std::nullopt);
  EXPECT_EQ(ring.size(), 0u);
  EXPECT_EQ(ring.dropped(), 2u);
}

TEST(SpscDropOldestRing, BehavesAsADequeThatLosesItsFront) {
  test::check_property([](const std::vector<std::uint8_t>& commands) {
    std::array<SpscDropOldestRing<std::uint8_t>::Slot, 4> storage;
    SpscDropOldestRing<std::uint8_t> ring(storage);
    std::deque<std::uint8_t> model;
    std::uint64_t dropped = 0;
    for (const std::uint8_t command : commands) {
      if (command % 3 != 0) {
        ring.push(command);
        model.push_back(command);
        if (model.size() > storage.size()) model.pop_front(), ++dropped;
      } else {
        RC_ASSERT(ring.pop() == (model.empty() ? std::nullopt : std::optional(model.front())));
        if (!model.empty()) model.pop_front();
      }
      RC_ASSERT(ring.size() == model.size());
      RC_ASSERT(ring.dropped() == dropped);
    }
  });
}

// 512 bytes, so that copies take long and overlap with stores; every word follows from the number.
struct Packet {
  std::array<std::uint64_t, 64> words{};

  static Packet numbered(std::uint64_t number) {
    Packet packet;
    for (std::size_t i = 0; i < packet.words.size(); ++i) packet.words[i] = number * (2 * i + 1);
    return packet;
  }
  [[nodiscard]] bool torn() const { return words != numbered(words[0]).words; }
};

struct Received {
  std::uint64_t elements = 0;
  std::uint64_t torn = 0;
  std::uint64_t disordered = 0;
  std::uint64_t last = 0;

  void add(const Packet& packet) {
    torn += packet.torn() ? 1 : 0;
    disordered += elements > 0 && packet.words[0] <= last ? 1 : 0;
    last = packet.words[0];
    ++elements;
  }
};

// The producer never waits for the consumer; now and then it offers it the core, in case there is only one.
Received hammer(SpscDropOldestRing<Packet>& ring, std::uint64_t packets) {
  constexpr std::uint64_t kBurst = 1000;
  std::atomic<bool> done{false};
  std::thread producer([&] {
    for (std::uint64_t i = 1; i <= packets; ++i) {
      ring.push(Packet::numbered(i));
      if (i % kBurst == 0) std::this_thread::yield();
    }
    done.store(true, std::memory_order_release);
  });
  Received received;
  for (bool last_round = false; !last_round;) {
    last_round = done.load(std::memory_order_acquire);
    while (const std::optional<Packet> packet = ring.pop()) received.add(*packet);
    std::this_thread::yield();
  }
  producer.join();
  return received;
}

TEST(SpscDropOldestRing, GivenAProducerThreadThatNeverWaitsThenNothingIsTornReorderedOrUncounted) {
  constexpr std::uint64_t kPackets = 100'000;
  for (const std::size_t capacity : {1u, 2u, 8u, 64u}) {
    std::vector<SpscDropOldestRing<Packet>::Slot> storage(capacity);
    SpscDropOldestRing<Packet> ring(storage);
    const Received received = hammer(ring, kPackets);
    EXPECT_EQ(received.torn, 0u);
    EXPECT_EQ(received.disordered, 0u);
    EXPECT_EQ(received.last, kPackets) << "the newest wins";
    EXPECT_EQ(received.elements + ring.dropped() + ring.size(), kPackets);
    EXPECT_EQ(ring.size(), 0u);
    RecordProperty("popped_of_capacity_" + std::to_string(capacity), static_cast<int>(received.elements));
  }
}

}  // namespace
}  // namespace lxd::rt_drop_oldest_ring_test
