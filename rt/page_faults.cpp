// SPDX-License-Identifier: Apache-2.0
// Page faults of the calling thread (see the header).
#include "rt/page_faults.hpp"

#include <sys/resource.h>

namespace lxd {

PageFaults thread_page_faults() noexcept {
  rusage usage{};
  (void)getrusage(RUSAGE_THREAD, &usage);  // fails only for a bad argument
  return {static_cast<std::uint64_t>(usage.ru_minflt), static_cast<std::uint64_t>(usage.ru_majflt)};
}

}  // namespace lxd
