// SPDX-License-Identifier: Apache-2.0
// Where and how urgently a thread runs. Each thread places itself, once, as the first thing it does; what the system
// does not permit is left as it was and told by its error number, so that a rig without privileges runs all the same.
#pragma once

#include <cstddef>
#include <cstdint>

namespace lxd {

// One thread of a board profile.
struct ThreadPlacement {
  const char* name = "";        // what top and /proc show: at most 15 characters, the rest is cut off
  int fifo_priority = 0;        // SCHED_FIFO 1 .. 99; 0: the ordinary scheduler
  int nice = 0;                 // of the ordinary scheduler, -20 .. 19
  std::uint64_t cpus = 0;       // bit n: CPU n. Of these the ones that there are; 0, or none of them there: any
  std::size_t stack_bytes = 0;  // of its stack to make resident
};

// What came of it. An error number is 0 where the wish was granted in full.
struct PlacementReport {
  int fifo_priority = 0;        // in force; lower than asked for where the limit (ulimit -r) is; 0: ordinary scheduler
  int nice = 0;                 // in force
  std::uint64_t cpus = 0;       // in force; CPUs beyond 63 do not show
  std::size_t stack_bytes = 0;  // made resident
  int scheduler_errno = 0;      // EPERM: neither CAP_SYS_NICE nor a limit that is high enough
  int nice_errno = 0;
  int affinity_errno = 0;  // EINVAL: none of the CPUs is there

  [[nodiscard]] bool as_wanted() const { return scheduler_errno == 0 && nice_errno == 0 && affinity_errno == 0; }
};

// Of the calling thread. Not for the real-time path: it comes before it.
PlacementReport place_this_thread(const ThreadPlacement& wanted);

}  // namespace lxd
