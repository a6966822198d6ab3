// SPDX-License-Identifier: Apache-2.0
// The counters that the hook writes, and the proof that there is a hook (see the header).
#include "rt/allocation_guard.hpp"

#include <cstdlib>

namespace lxd {

namespace allocation_detail {
constinit thread_local AllocationCounts counts;
}  // namespace allocation_detail

bool AllocationGuard::active() {
  const AllocationCounts before = allocation_detail::now();
  void* volatile probe = std::malloc(1);  // volatile: the compiler may not drop the pair
  std::free(probe);
  const AllocationCounts after = allocation_detail::now();
  allocation_detail::counts = before;
  return after.allocations == before.allocations + 1 && after.frees == before.frees + 1;
}

}  // namespace lxd
