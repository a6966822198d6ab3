// SPDX-License-Identifier: Apache-2.0
#include "board/pacer.hpp"

#include <algorithm>
#include <thread>

namespace lxd {
namespace {

constexpr std::chrono::milliseconds kStopLatency{50};  // a wait looks this often whether it shall stop

}  // namespace

void Pacer::wait_until(RigTime due, const std::atomic<bool>& stopping) {
  using Clock = std::chrono::steady_clock;
  if (!start_) start_ = Start{Clock::now(), due};
  const Clock::time_point target = start_->wall + std::chrono::nanoseconds((due - start_->rig).ns());
  for (Clock::time_point now = Clock::now(); now < target && !stopping; now = Clock::now()) {
    std::this_thread::sleep_until(std::min(target, now + kStopLatency));
  }
}

}  // namespace lxd
