// SPDX-License-Identifier: Apache-2.0
// Work shared out to threads: taken in order, each item once, and ended at the first failure.
#include <atomic>
#include <numeric>

#include <gtest/gtest.h>

#include "tools/simulator/lidar/ordered_work.hpp"

namespace lxd::test::simulator_ordered_work_test {
namespace {

using sim::work_in_order;

TEST(OrderedWorkThreads, ItemsAreTakenInOrderWhateverTheNumberOfWorkers) {
  std::vector<std::size_t> wanted(100);
  std::iota(wanted.begin(), wanted.end(), std::size_t{0});
  for (const unsigned workers : {0U, 1U, 2U, 7U}) {
    std::vector<std::size_t> taken;
    const Status status = work_in_order<std::vector<std::size_t>>(
        wanted.size(), workers, [](std::size_t i) { return std::vector<std::size_t>(i + 1, i); },
        [&](std::size_t i, const std::vector<std::size_t>& made) {
          EXPECT_EQ(made.size(), i + 1);
          taken.push_back(made.back());
          return success();
        });
    EXPECT_TRUE(status.ok());
    EXPECT_EQ(taken, wanted);
  }
}

TEST(OrderedWorkThreads, TheFirstFailureEndsIt) {
  std::atomic<std::size_t> made{0};
  const Status status = work_in_order<std::size_t>(
      1000, 3, [&](std::size_t i) { return ++made, i; },
      [](std::size_t i, std::size_t) -> Status { return i == 5 ? Status(Error{"full"}) : success(); });
  ASSERT_FALSE(status.ok());
  EXPECT_EQ(status.error().message, "full");
  EXPECT_LT(made.load(), 20U);  // no more than what was under way
}

TEST(OrderedWorkThreads, NoItemsAreNoWork) {
  const auto none = [](std::size_t) { return 0; };
  EXPECT_TRUE(work_in_order<int>(0, 2, none, [](std::size_t, int) { return success(); }).ok());
}

}  // namespace
}  // namespace lxd::test::simulator_ordered_work_test
