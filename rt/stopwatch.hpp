// SPDX-License-Identifier: Apache-2.0
// Elapsed time on CLOCK_MONOTONIC: it never steps, whatever NTP or PTP do to the wall clock. Not a rig time: results
// measured with it go into latencies only, never into estimates, so that a replay stays deterministic.
#pragma once

#include <ctime>

#include "rt/nonblocking.hpp"
#include "rt/time.hpp"

namespace lxd {

class Stopwatch {
 public:
  Stopwatch() noexcept LXD_NONBLOCKING : begin_(now()) {}

  [[nodiscard]] Duration elapsed() const noexcept LXD_NONBLOCKING { return now() - begin_; }

  // The elapsed time, and starts again from now.
  Duration lap() noexcept LXD_NONBLOCKING {
    const Duration instant = now();
    const Duration span = instant - begin_;
    begin_ = instant;
    return span;
  }

  // CLOCK_MONOTONIC since its own zero (Linux: since boot).
  [[nodiscard]] static Duration now() noexcept LXD_NONBLOCKING {
    timespec t{};
    LXD_KNOWN_NONBLOCKING_BEGIN                     // a read of the vDSO's page on every architecture we build for
        (void) clock_gettime(CLOCK_MONOTONIC, &t);  // cannot fail: the clock exists and t is ours
    LXD_KNOWN_NONBLOCKING_END
    return Duration::from_ns(t.tv_sec * kNanosPerSecond + t.tv_nsec);
  }

 private:
  Duration begin_;
};

}  // namespace lxd
