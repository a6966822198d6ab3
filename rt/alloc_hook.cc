// SPDX-License-Identifier: Apache-2.0
// The C allocator of the executable that links this object: counts for the calling thread, then does what glibc does.
// libstdc++'s operator new and every shared library end here too. Sanitizers bring an allocator of their own, other C
// libraries have no __libc_malloc: there it is left out, and AllocationGuard::active() is false.
#include <cerrno>
#include <cstddef>
#include <cstdlib>

#include "rt/allocation_guard.hpp"

#if defined(__GLIBC__) && !defined(LXD_SANITIZED)

extern "C" {

// glibc's own names for what we replace (malloc/malloc.c; exported, but in no header).
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void* __libc_valloc(std::size_t size);
void* __libc_pvalloc(std::size_t size);
void __libc_free(void* block);

void* malloc(std::size_t size) {
  ++lxd::allocation_detail::counts.allocations;
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) {
  ++lxd::allocation_detail::counts.allocations;
  return __libc_calloc(count, size);
}

// One allocation, also when it gives memory back.
void* realloc(void* old, std::size_t size) {
  ++lxd::allocation_detail::counts.allocations;
  return __libc_realloc(old, size);
}

void* memalign(std::size_t alignment, std::size_t size) {
  ++lxd::allocation_detail::counts.allocations;
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) {
  ++lxd::allocation_detail::counts.allocations;
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  const bool power_of_two = alignment != 0 && (alignment & (alignment - 1)) == 0;
  if (!power_of_two || alignment % sizeof(void*) != 0) return EINVAL;
  const int saved_errno = errno;  // POSIX: reports by its result only
  ++lxd::allocation_detail::counts.allocations;
  void* const memory = __libc_memalign(alignment, size);
  errno = saved_errno;
  if (memory == nullptr) return ENOMEM;
  *block = memory;
  return 0;
}

void* valloc(std::size_t size) {
  ++lxd::allocation_detail::counts.allocations;
  return __libc_valloc(size);
}

void* pvalloc(std::size_t size) {
  ++lxd::allocation_detail::counts.allocations;
  return __libc_pvalloc(size);
}

void free(void* block) {
  if (block != nullptr) ++lxd::allocation_detail::counts.frees;
  __libc_free(block);
}

}  // extern "C"

#endif
