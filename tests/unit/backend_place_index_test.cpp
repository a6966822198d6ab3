// SPDX-License-Identifier: Apache-2.0
// The index of places by ring keys: as right as asking all of them, with less work.
#include <algorithm>
#include <random>

#include <gtest/gtest.h>

#include "backend/loops/place_index.hpp"

namespace lxd::backend_place_index_test {
namespace {

class Keys {
 public:
  RingKey next() {
    RingKey key{};
    for (float& x : key) x = static_cast<float>(engine_() >> 8) / static_cast<float>(1U << 24);
    return key;
  }

 private:
  std::mt19937 engine_{5};
};

float distance2(const RingKey& a, const RingKey& b) {
  float sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sum;
}

std::vector<std::uint32_t> numbers(const std::vector<NearPlace>& places) {
  std::vector<std::uint32_t> out;
  for (const NearPlace& place : places) out.push_back(place.place);
  return out;
}

TEST(PlaceIndex, AnswersAsAskingAllDoes) {
  Keys keys;
  PlaceIndex index;
  std::vector<RingKey> all;
  for (std::uint32_t i = 0; i < 1000; ++i) {
    all.push_back(keys.next());
    index.add(all.back(), i);
    if (i % 97 != 0) continue;
    const RingKey wanted = keys.next();
    std::vector<std::uint32_t> order(all.size());
    for (std::uint32_t k = 0; k < order.size(); ++k) order[k] = k;
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return distance2(all[a], wanted) < distance2(all[b], wanted); });
    order.resize(std::min<std::size_t>(order.size(), 10));
    EXPECT_EQ(numbers(index.nearest({.key = wanted, .count = 10, .visits_max = 100000, .allowed = {}})), order) << i;
  }
  EXPECT_EQ(index.size(), 1000U);
}

TEST(PlaceIndex, KeepsToWhatIsAllowed) {
  Keys keys;
  PlaceIndex index;
  for (std::uint32_t i = 0; i < 200; ++i) index.add(keys.next(), i);
  const auto found = index.nearest(
      {.key = keys.next(), .count = 20, .visits_max = 100000, .allowed = [](std::uint32_t i) { return i < 50; }});
  EXPECT_EQ(found.size(), 20U);
  for (const NearPlace& place : found) EXPECT_LT(place.place, 50U);
}

TEST(PlaceIndex, LooksAtNoMoreThanItMay) {
  Keys keys;
  PlaceIndex index;
  constexpr std::uint32_t kPlaces = 32 * 256;  // one tree
  for (std::uint32_t i = 0; i < kPlaces; ++i) index.add(keys.next(), i);
  std::size_t looked = 0;
  const auto count = [&](std::uint32_t) {
    ++looked;
    return false;
  };
  EXPECT_TRUE(index.nearest({.key = keys.next(), .count = 5, .visits_max = 100, .allowed = count}).empty());
  EXPECT_LE(looked, 100U);
  EXPECT_GT(looked, 50U);
}

TEST(PlaceIndex, OfEquallyNearPlacesTheNewestIsFirst) {
  PlaceIndex index;
  for (std::uint32_t i = 0; i < 100; ++i) index.add({}, i);
  EXPECT_EQ(numbers(index.nearest({.key = {}, .count = 3, .visits_max = 1000, .allowed = {}})),
            (std::vector<std::uint32_t>{99, 98, 97}));
}

TEST(PlaceIndex, WithoutPlacesOrWishesGivesNothing) {
  PlaceIndex index;
  EXPECT_TRUE(index.nearest({.key = {}, .count = 3, .visits_max = 10, .allowed = {}}).empty());
  index.add({}, 0);
  EXPECT_TRUE(index.nearest({.key = {}, .count = 0, .visits_max = 10, .allowed = {}}).empty());
}

}  // namespace
}  // namespace lxd::backend_place_index_test
