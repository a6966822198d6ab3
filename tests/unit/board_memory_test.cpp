// SPDX-License-Identifier: Apache-2.0
// The memory budget tells every cut and refuses what does not fit.
#include <array>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "board/default/capacities.hpp"
#include "board/memory.hpp"

namespace lxd::board_memory_test {
namespace {

class BoardMemory : public testing::Test {
 protected:
  alignas(Arena::kAlignment) std::array<std::byte, 1024> block_{};
  Arena arena_{block_};
};

// Given two equal pools and one of another kind, then the equal ones are one row, and the total has what the process
// takes beside its pools.
TEST_F(BoardMemory, TableAndJsonListEqualPoolsOnceAndTheSum) {
  ASSERT_EQ(arena_.take<double>("doubles", 3).size(), 3U);
  ASSERT_EQ(arena_.take<double>("doubles", 3).size(), 3U);
  ASSERT_EQ(arena_.take<char>("letters", 5).size(), 5U);
  const std::string table = budget_table(arena_);
  for (const char* word : {"doubles", "letters", "all pools", "program, libraries", "total"}) {
    EXPECT_NE(table.find(word), std::string::npos) << table;
  }
  EXPECT_EQ(table.find("doubles"), table.rfind("doubles"));
  const auto json = nlohmann::json::parse(budget_json(arena_));
  ASSERT_EQ(json["pools"].size(), 2U);
  EXPECT_EQ(json["pools"][0]["pools"], 2);
  EXPECT_EQ(json["pools"][0]["element_bytes"], 8);
  EXPECT_EQ(json["pools"][0]["bytes"], 88);
  EXPECT_EQ(json["pools"][1]["name"], "letters");
  EXPECT_EQ(json["pools_bytes"], 133);  // 24, padded to a cache line, 24, padded, and 5
  EXPECT_EQ(json["capacity_bytes"], 1024);
  EXPECT_EQ(json["total_bytes"], 133 + capacities::kOutsideArenaBytes);
  EXPECT_TRUE(check_fits(arena_));
}

TEST_F(BoardMemory, WhatDoesNotFitIsRefusedWithTheSum) {
  EXPECT_TRUE(arena_.take<char>("too much", 2000).empty());
  const Status fits = check_fits(arena_);
  ASSERT_FALSE(fits);
  EXPECT_NE(fits.error().message.find("wants 2000 bytes"), std::string::npos) << fits.error().message;
  EXPECT_NE(fits.error().message.find("too much"), std::string::npos) << fits.error().message;
}

TEST(BoardStaticMemory, IsAlignedAndAsLargeAsTheProfileSays) {
  Arena arena = static_arena();
  EXPECT_EQ(arena.capacity_bytes(), capacities::kArenaBytes);
  const auto bytes = arena.take<std::byte>("first", 1);
  EXPECT_EQ(reinterpret_cast<std::uintptr_t>(bytes.data()) % Arena::kAlignment, 0U);
}

}  // namespace
}  // namespace lxd::board_memory_test
