// SPDX-License-Identifier: Apache-2.0
// Ctrl-C, and a service manager's SIGTERM, as a flag that a long command looks at: the run ends cleanly and whole.
#pragma once

#include <atomic>

namespace lxd {

// Becomes true at the first SIGINT or SIGTERM from now on; a second one ends the program at once.
const std::atomic<bool>& watch_for_interrupt();

}  // namespace lxd
