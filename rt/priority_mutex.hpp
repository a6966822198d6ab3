// SPDX-License-Identifier: Apache-2.0
// A lock for threads of different urgency, outside of the real-time path: whoever holds it runs at least as urgently as
// whoever waits for it, so that the back-end cannot be kept from releasing what an I/O thread wants. For
// std::lock_guard and std::unique_lock. Which lock the real-time path takes: none.
#pragma once

#include <pthread.h>

namespace lxd {

class PriorityMutex {
 public:
  PriorityMutex();
  PriorityMutex(const PriorityMutex&) = delete;
  PriorityMutex& operator=(const PriorityMutex&) = delete;
  ~PriorityMutex();

  void lock();
  bool try_lock();
  void unlock();

  // Whether the C library knows priority inheritance; without it, a lock like any other.
  [[nodiscard]] bool inherits() const { return inherits_; }

 private:
  pthread_mutex_t mutex_{};
  bool inherits_ = false;
};

}  // namespace lxd
