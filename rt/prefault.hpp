// SPDX-License-Identifier: Apache-2.0
// Makes resident what the process has mapped, so that the real-time thread meets no page fault. Needs no privilege;
// where the memory-lock limit allows it, it also pins what is resident. Called once at the end of start-up, when all
// threads exist and none of them maps or unmaps; the stack part once by each real-time thread.
#pragma once

#include <cstddef>

#include "rt/result.hpp"

namespace lxd {

struct PrefaultOptions {
  // Mappings of larger files stay out: they are recordings being read, not code or data of the program.
  std::size_t file_limit_bytes = std::size_t{64} << 20;
  // Anonymous mappings beyond are reserved address space, such as a sanitizer's shadow, not memory in use.
  std::size_t reserve_limit_bytes = std::size_t{4} << 30;
  // Of another thread's stack, its top so many bytes: a default stack is 8 MiB, of which little is ever used.
  std::size_t other_stack_bytes = std::size_t{256} << 10;
  bool lock = true;  // try to pin
};

struct PrefaultReport {
  std::size_t mappings = 0;        // made resident
  std::size_t resident_bytes = 0;  // in them
  std::size_t skipped = 0;         // mappings left out: unreadable, kernel pages, large files, reserves
  bool locked = false;             // pages cannot be evicted any more
  int lock_errno = 0;              // why not (EPERM, ENOMEM: see ulimit -l)
};

// Error: /proc/self/maps cannot be read, or the kernel is older than 5.14 (MADV_POPULATE_READ).
[[nodiscard]] Result<PrefaultReport> prefault_process(const PrefaultOptions& options = {});

// Touches the next bytes of the calling thread's stack below the caller's frame; at most what the stack still has less
// a safety margin. Returns the bytes touched.
std::size_t prefault_stack(std::size_t bytes);

}  // namespace lxd
