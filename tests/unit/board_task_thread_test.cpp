// SPDX-License-Identifier: Apache-2.0
// Tasks are done in order, in a thread of their own; whoever posts them may wait until few are left.
#include <algorithm>
#include <chrono>
#include <latch>
#include <thread>
#include <vector>

#include <gtest/gtest.h>

#include "board/default/threads.hpp"
#include "board/task_thread.hpp"

namespace lxd::board_task_thread_test {
namespace {

TEST(BoardTaskThread, GivenManyTasksThenAllAreDoneInOrderByAnotherThread) {
  std::vector<int> done;
  std::thread::id worker;
  TaskThread thread(threads::kBackEnd);
  for (int i = 0; i < 1000; ++i)
    thread.post([&, i] {
      done.push_back(i);
      worker = std::this_thread::get_id();
    });
  thread.wait_until_left(0);
  ASSERT_EQ(done.size(), 1000U);
  EXPECT_TRUE(std::ranges::is_sorted(done));
  EXPECT_NE(worker, std::this_thread::get_id());
}

// Given one that is at work and two that wait, when two may be left, then nobody returns before the first is done.
TEST(BoardTaskThread, GivenWhoeverWaitsForFewThenOnlySoManyAreLeft) {
  std::latch go(1), stay(1);
  int done = 0;
  TaskThread thread(threads::kBackEnd);
  thread.post([&] {
    go.wait();
    ++done;
  });
  thread.post([&] { stay.wait(); });
  thread.post([] {});
  thread.wait_until_left(3);  // at once
  EXPECT_EQ(done, 0);
  go.count_down();
  thread.wait_until_left(2);
  EXPECT_EQ(done, 1);
  stay.count_down();
}

// Given tasks that wait when the thread ends, then the one at work is finished and the others are not begun.
TEST(BoardTaskThread, GivenTheEndThenWhatWaitsIsDropped) {
  std::latch at_work(1), go(1);
  int done = 0;
  std::thread opener;
  {
    TaskThread thread(threads::kBackEnd);
    thread.post([&] {
      at_work.count_down();
      go.wait();
      ++done;
    });
    at_work.wait();
    for (int i = 0; i < 5; ++i) thread.post([&] { done += 100; });
    opener = std::thread([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      go.count_down();
    });
  }
  opener.join();
  EXPECT_EQ(done, 1);
}

}  // namespace
}  // namespace lxd::board_task_thread_test
