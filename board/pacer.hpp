// SPDX-License-Identifier: Apache-2.0
// Plays a recording's time at the speed of the wall clock.
#pragma once

#include <atomic>
#include <chrono>
#include <optional>

#include "rt/time.hpp"

namespace lxd {

// One thread's.
class Pacer {
 public:
  // Sleeps until `due` has come; the first call sets the two clocks equal. Returns early when `stopping` becomes true.
  void wait_until(RigTime due, const std::atomic<bool>& stopping);

 private:
  struct Start {
    std::chrono::steady_clock::time_point wall;
    RigTime rig;
  };
  std::optional<Start> start_;
};

}  // namespace lxd
