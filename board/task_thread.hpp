// SPDX-License-Identifier: Apache-2.0
// Work for a thread of its own, in the order in which it is posted.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

#include "rt/thread_placement.hpp"

namespace lxd {

class TaskThread {
 public:
  using Task = std::function<void()>;

  // Where the system refuses the placement, the thread runs under the ordinary scheduler.
  explicit TaskThread(const ThreadPlacement& placement);
  // What still waits is dropped.
  ~TaskThread();
  TaskThread(const TaskThread&) = delete;
  TaskThread& operator=(const TaskThread&) = delete;

  void post(Task task);
  // Until at most so many wait or are at work; 0: until all is done.
  void wait_until_left(std::size_t tasks);

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable came_, done_;
  std::deque<Task> queue_;  // the one at work is its front
  bool ending_ = false;
  std::thread thread_;  // last: starts when all else is there
};

}  // namespace lxd
