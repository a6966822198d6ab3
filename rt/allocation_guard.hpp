// SPDX-License-Identifier: Apache-2.0
// Counts what the calling thread allocates and frees, so that a program can prove in its own report (and a test can
// assert) that the real-time path does neither. Counting needs the interposed malloc of rt/alloc_hook.cc: an executable
// links it with target_link_libraries(<executable> PRIVATE lxd_alloc_hook). Without it, and under a sanitizer, all
// counts stay 0 and active() says so.
#pragma once

#include <cstdint>

#include "rt/nonblocking.hpp"

namespace lxd {

struct AllocationCounts {
  std::uint64_t allocations = 0;  // malloc, calloc, realloc, aligned forms, operator new
  std::uint64_t frees = 0;        // free of anything but nullptr, operator delete
};

namespace allocation_detail {
// Of the calling thread, since it began; the hook writes it. constinit: a first use must not itself allocate.
extern constinit thread_local AllocationCounts counts __attribute__((tls_model("initial-exec")));

inline AllocationCounts now() noexcept LXD_NONBLOCKING {
  LXD_KNOWN_NONBLOCKING_BEGIN  // initial-exec: the variable exists since the thread does, an access is one load
      const volatile AllocationCounts& current =
          counts;  // volatile: compilers take it that malloc writes no variable of ours
  LXD_KNOWN_NONBLOCKING_END
  return {current.allocations, current.frees};
}
}  // namespace allocation_detail

class AllocationGuard {
 public:
  AllocationGuard() noexcept LXD_NONBLOCKING : begin_(allocation_detail::now()) {}

  // Allocations of this thread since construction. Call it on the thread that made the guard.
  [[nodiscard]] std::uint64_t count() const noexcept LXD_NONBLOCKING {
    return allocation_detail::now().allocations - begin_.allocations;
  }
  // Likewise, memory given back.
  [[nodiscard]] std::uint64_t frees() const noexcept LXD_NONBLOCKING {
    return allocation_detail::now().frees - begin_.frees;
  }

  // Whether this executable counts at all; found out by allocating, so not for the real-time path. Leaves the counts of
  // live guards as they were. A zero means something only when this is true.
  [[nodiscard]] static bool active();

 private:
  AllocationCounts begin_;
};

}  // namespace lxd
