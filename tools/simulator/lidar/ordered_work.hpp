// SPDX-License-Identifier: Apache-2.0
// Items made by several threads and taken by the caller's in their order, a few at a time in memory: the result does
// not depend on the number of threads.
#pragma once

#include <algorithm>
#include <condition_variable>
#include <cstddef>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "rt/result.hpp"

namespace lxd::sim {

// Room for one item between the thread that makes and the one that takes.
template <typename T>
class HandOver {
 public:
  // False: nobody will take it any more.
  bool put(T item) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return closed_ || !item_; });
    if (closed_) return false;
    item_ = std::move(item);
    changed_.notify_all();
    return true;
  }
  T take() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return item_.has_value(); });
    T item = std::move(*item_);
    item_.reset();
    changed_.notify_all();
    return item;
  }
  void close() {
    const std::scoped_lock lock(mutex_);
    closed_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::optional<T> item_;
  bool closed_ = false;
};

// make(i) -> T on any thread, for i = 0 .. count - 1; take(i, T) -> Status on this one, in order, until it fails.
template <typename T, typename Make, typename Take>
Status work_in_order(std::size_t count, unsigned threads, const Make& make, const Take& take) {
  const std::size_t workers = std::max<std::size_t>(threads, 1);
  std::vector<std::unique_ptr<HandOver<T>>> lanes;  // worker k makes the items k, k + workers, ...
  for (std::size_t k = 0; k < workers; ++k) lanes.push_back(std::make_unique<HandOver<T>>());
  std::vector<std::jthread> pool;
  for (std::size_t k = 0; k < workers; ++k) {
    pool.emplace_back([&make, &lane = *lanes[k], k, count, workers] {
      for (std::size_t i = k; i < count && lane.put(make(i)); i += workers) {
      }
    });
  }
  Status status = success();
  for (std::size_t i = 0; i < count && status.ok(); ++i) status = take(i, lanes[i % workers]->take());
  for (auto& lane : lanes) lane->close();
  return status;
}

}  // namespace lxd::sim
