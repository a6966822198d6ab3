// SPDX-License-Identifier: Apache-2.0
// Makes the process resident (see the header). MADV_POPULATE_* fault pages in as an access would, without an access: a
// page that cannot be read is an error number, not a signal, and no other thread's data is touched.
#include "rt/prefault.hpp"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <alloca.h>
#include <pthread.h>
#include <sys/mman.h>
#include <unistd.h>

#include "rt/memory_map.hpp"

namespace lxd {
namespace {

// linux/mman.h since 5.14; older C libraries do not name them.
constexpr int kPopulateRead = 22;
constexpr int kPopulateWrite = 23;

std::size_t page_bytes() { return static_cast<std::size_t>(sysconf(_SC_PAGESIZE)); }

struct Extent {
  std::uintptr_t begin = 0;
  std::size_t bytes = 0;
};

// Pages that the kernel maps for itself: they are no memory of ours and refuse to be populated.
bool is_kernel_page(const Mapping& mapping) {
  const std::string_view name = mapping.name;
  return name.starts_with("[vvar") || name == "[vsyscall]" || name == "[vdso]";
}

bool wanted(const Mapping& mapping, const PrefaultOptions& options) {
  const bool large_file = mapping.inode != 0 && mapping.bytes() > options.file_limit_bytes;
  const bool reserve = mapping.inode == 0 && mapping.bytes() > options.reserve_limit_bytes;
  return mapping.readable && !is_kernel_page(mapping) && !large_file && !reserve;
}

// pthread stacks are anonymous memory directly above a small inaccessible guard (an arena of malloc has its large
// inaccessible reserve above it).
bool is_thread_stack(const Mapping& below, const Mapping& mapping) {
  constexpr std::size_t kLargestGuard_bytes = std::size_t{64} << 10;
  const auto anonymous = [](const Mapping& m) { return m.inode == 0 && m.name.empty(); };
  const bool guard = anonymous(below) && !below.readable && !below.writable && below.bytes() <= kLargestGuard_bytes;
  return guard && below.end == mapping.begin && anonymous(mapping) && mapping.writable;
}

// The part of mapping i to make resident.
Extent extent(std::span<const Mapping> map, std::size_t i, const PrefaultOptions& options) {
  const Mapping& mapping = map[i];
  const bool stack = i > 0 && is_thread_stack(map[i - 1], mapping);
  const std::size_t stack_bytes = options.other_stack_bytes / page_bytes() * page_bytes();
  const std::size_t bytes = stack ? std::min(mapping.bytes(), stack_bytes) : mapping.bytes();
  return {mapping.end - bytes, bytes};
}

// Private writable pages become our own copies now; the rest are only brought in. False: the kernel refused.
bool populate(const Extent& extent, bool write) {
  void* const begin = reinterpret_cast<void*>(extent.begin);
  return madvise(begin, extent.bytes, write ? kPopulateWrite : kPopulateRead) == 0;
}

bool kernel_can_populate() {
  alignas(16) static const char probe = 0;
  const std::uintptr_t page = reinterpret_cast<std::uintptr_t>(&probe) / page_bytes() * page_bytes();
  return populate({page, page_bytes()}, false);
}

// MCL_ONFAULT: what is resident is pinned, and what we left out on purpose is not brought in.
void lock(PrefaultReport& report) {
  report.locked = mlockall(MCL_CURRENT | MCL_ONFAULT) == 0;
  report.lock_errno = report.locked ? 0 : errno;
}

// Bytes of the calling thread's stack below this frame.
std::size_t stack_left() {
  pthread_attr_t attributes;
  if (pthread_getattr_np(pthread_self(), &attributes) != 0) return 0;
  void* lowest = nullptr;
  std::size_t bytes = 0;
  const bool known = pthread_attr_getstack(&attributes, &lowest, &bytes) == 0;
  (void)pthread_attr_destroy(&attributes);  // frees only
  const char here = 0;
  return known ? reinterpret_cast<std::uintptr_t>(&here) - reinterpret_cast<std::uintptr_t>(lowest) : 0;
}

}  // namespace

Result<PrefaultReport> prefault_process(const PrefaultOptions& options) {
  if (!kernel_can_populate())
    return Error{std::string("madvise(MADV_POPULATE_READ): ") + std::strerror(errno) + "; wanted Linux 5.14 or later"};
  const Result<std::vector<Mapping>> map = read_memory_map();
  if (!map) return map.error();
  PrefaultReport report;
  for (std::size_t i = 0; i < map->size(); ++i) {
    const Mapping& mapping = (*map)[i];
    const Extent part = extent(*map, i, options);
    const bool resident = wanted(mapping, options) && populate(part, mapping.writable && !mapping.shared);
    report.mappings += resident ? 1 : 0;
    report.resident_bytes += resident ? part.bytes : 0;
    report.skipped += resident ? 0 : 1;
  }
  if (options.lock) lock(report);
  return report;
}

[[gnu::noinline]] std::size_t prefault_stack(std::size_t bytes) {
  constexpr std::size_t kMargin_bytes = std::size_t{64} << 10;  // for this frame, signal handlers and the guard
  const std::size_t left = stack_left();
  const std::size_t wanted_bytes = left > kMargin_bytes ? std::min(bytes, left - kMargin_bytes) : 0;
  if (wanted_bytes == 0) return 0;
  volatile char* const block = static_cast<volatile char*>(alloca(wanted_bytes));
  for (std::size_t i = wanted_bytes; i > 0; i -= std::min(i, page_bytes())) block[i - 1] = 0;  // downward, as it grows
  block[0] = 0;
  return wanted_bytes;
}

}  // namespace lxd
