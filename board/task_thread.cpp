// SPDX-License-Identifier: Apache-2.0
#include "board/task_thread.hpp"

#include <utility>

namespace lxd {

TaskThread::TaskThread(const ThreadPlacement& placement)
    : thread_([this, placement] {
        place_this_thread(placement);
        run();
      }) {}

TaskThread::~TaskThread() {
  {
    const std::lock_guard lock(mutex_);
    ending_ = true;
  }
  came_.notify_one();
  thread_.join();
}

void TaskThread::post(Task task) {
  {
    const std::lock_guard lock(mutex_);
    queue_.push_back(std::move(task));
  }
  came_.notify_one();
}

void TaskThread::wait_until_left(std::size_t tasks) {
  std::unique_lock lock(mutex_);
  done_.wait(lock, [&] { return queue_.size() <= tasks; });
}

// Elements of a deque stay where they are while others are pushed behind them.
void TaskThread::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    came_.wait(lock, [this] { return ending_ || !queue_.empty(); });
    if (ending_) return;
    Task& task = queue_.front();
    lock.unlock();
    task();
    lock.lock();
    queue_.pop_front();
    done_.notify_all();
  }
}

}  // namespace lxd
