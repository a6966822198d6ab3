// SPDX-License-Identifier: Apache-2.0
// See priority_mutex.hpp. Locking and unlocking a sound mutex of the default kind do not fail: their results are
// asserted.
#include "rt/priority_mutex.hpp"

#include <cassert>

namespace lxd {

PriorityMutex::PriorityMutex() {
  pthread_mutexattr_t attributes;
  pthread_mutexattr_init(&attributes);
  inherits_ = pthread_mutexattr_setprotocol(&attributes, PTHREAD_PRIO_INHERIT) == 0;
  if (pthread_mutex_init(&mutex_, &attributes) != 0) {  // a kernel without such futexes
    inherits_ = false;
    pthread_mutex_init(&mutex_, nullptr);
  }
  pthread_mutexattr_destroy(&attributes);
}

PriorityMutex::~PriorityMutex() { pthread_mutex_destroy(&mutex_); }

void PriorityMutex::lock() {
  [[maybe_unused]] const int failed = pthread_mutex_lock(&mutex_);
  assert(failed == 0);
}

bool PriorityMutex::try_lock() { return pthread_mutex_trylock(&mutex_) == 0; }

void PriorityMutex::unlock() {
  [[maybe_unused]] const int failed = pthread_mutex_unlock(&mutex_);
  assert(failed == 0);
}

}  // namespace lxd
