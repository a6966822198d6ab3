// SPDX-License-Identifier: Apache-2.0
// What became of a thread's placement, in words.
#pragma once

#include <string>

#include "rt/thread_placement.hpp"

namespace lxd {

// One line: the thread, where it runs, and what was refused and why.
// "lxd-filter: SCHED_FIFO 45, CPUs 3" or "lxd-filter: ordinary scheduler, nice 0, CPUs 0-1; SCHED_FIFO 45 was refused
// (Operation not permitted): see lxd-slam doctor".
std::string placement_text(const ThreadPlacement& wanted, const PlacementReport& report);

// "0-2,5"; the kernel's way to write a set of CPUs. Empty: "none".
std::string cpu_list(std::uint64_t cpus);

}  // namespace lxd
