// SPDX-License-Identifier: Apache-2.0
// Records of any length through a ring: whole, in order, refused when there is no room.
#include <numeric>
#include <random>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "rt/byte_ring.hpp"

namespace lxd::rt_byte_ring_test {
namespace {

using Record = std::vector<std::uint8_t>;

Record record_of(std::uint32_t number, std::size_t bytes) {
  Record record(bytes);
  std::iota(record.begin(), record.end(), static_cast<std::uint8_t>(number));
  return record;
}

Record popped(ByteRing& ring) {
  Record out(1024);
  out.resize(ring.pop(out).size());
  return out;
}

// Given records of all lengths, in all splits, then they come out whole and in order, over the storage's end too.
TEST(ByteRing, KeepsRecordsWhole) {
  std::vector<std::uint8_t> storage(256);
  ByteRing ring(storage);
  std::mt19937 random(1);
  for (std::uint32_t i = 0; i < 2000; ++i) {
    const Record record = record_of(i, 1 + random() % 200);
    const std::size_t split = random() % (record.size() + 1);
    ASSERT_TRUE(ring.push(std::span(record).first(split), std::span(record).subspan(split)));
    EXPECT_EQ(popped(ring), record);
  }
  EXPECT_TRUE(ring.empty());
  EXPECT_TRUE(popped(ring).empty());
}

TEST(ByteRing, RefusesWhatHasNoRoomAndKeepsTheRest) {
  std::vector<std::uint8_t> storage(64);
  ByteRing ring(storage);
  EXPECT_FALSE(ring.push({}, record_of(0, 61)));
  ASSERT_TRUE(ring.push({}, record_of(1, 40)));
  EXPECT_FALSE(ring.push({}, record_of(2, 17)));
  ASSERT_TRUE(ring.push({}, record_of(3, 16)));
  EXPECT_EQ(ring.high_water(), 64U);
  EXPECT_EQ(popped(ring), record_of(1, 40));
  EXPECT_EQ(popped(ring), record_of(3, 16));
}

TEST(ByteRing, WithoutStorageRefusesEverything) {
  ByteRing ring({});
  EXPECT_FALSE(ring.push({}, record_of(0, 1)));
  EXPECT_TRUE(popped(ring).empty());
}

// Given a producer and a consumer at full speed, then nothing is torn, lost or doubled.
TEST(ByteRingThread, CarriesRecordsBetweenTwoThreads) {
  constexpr std::uint32_t kRecords = 20'000;
  std::vector<std::uint8_t> storage(1024);
  ByteRing ring(storage);
  std::thread producer([&] {
    for (std::uint32_t i = 0; i < kRecords; ++i)
      while (!ring.push({}, record_of(i, 1 + i % 100))) std::this_thread::yield();
  });
  std::uint32_t wrong = 0;
  for (std::uint32_t i = 0; i < kRecords; ++i) {
    Record record = popped(ring);
    for (; record.empty(); record = popped(ring)) std::this_thread::yield();
    wrong += record != record_of(i, 1 + i % 100);
  }
  producer.join();
  EXPECT_EQ(wrong, 0U);
}

}  // namespace
}  // namespace lxd::rt_byte_ring_test
