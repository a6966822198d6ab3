// SPDX-License-Identifier: Apache-2.0
#include "tools/cli/interrupt.hpp"

#include <csignal>

namespace lxd {
namespace {

static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may touch only lock-free atomics");

// A signal handler has no argument of its own: this flag is the only way to it.
std::atomic<bool>& flag() {
  static constinit std::atomic<bool> interrupted{false};
  return interrupted;
}

void on_signal(int) { flag() = true; }

}  // namespace

const std::atomic<bool>& watch_for_interrupt() {
  struct sigaction action {};
  action.sa_handler = on_signal;
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  return flag();
}

}  // namespace lxd
