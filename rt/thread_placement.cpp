// SPDX-License-Identifier: Apache-2.0
// See thread_placement.hpp. Linux: scheduling, nice value and affinity belong to the thread (sched(7)).
#include "rt/thread_placement.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <pthread.h>
#include <sched.h>
#include <sys/resource.h>
#include <unistd.h>

#include "rt/prefault.hpp"

namespace lxd {
namespace {

constexpr int kMaskBits = 64;
constexpr std::size_t kNameBytes = 16;  // with the closing zero: TASK_COMM_LEN

void set_name(const char* name) {
  std::array<char, kNameBytes> cut{};
  std::strncpy(cut.data(), name, cut.size() - 1);
  (void)pthread_setname_np(pthread_self(), cut.data());  // fails only for longer names
}

// 0 or the error number.
int set_fifo(int priority) {
  sched_param parameter{};
  parameter.sched_priority = priority;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameter);
}

// Without the capability the limit is the highest that may be had.
int allowed_priority() {
  rlimit limit{};
  if (getrlimit(RLIMIT_RTPRIO, &limit) != 0) return 0;
  return static_cast<int>(std::min<rlim_t>(limit.rlim_cur, static_cast<rlim_t>(sched_get_priority_max(SCHED_FIFO))));
}

void schedule(int priority, PlacementReport& report) {
  if (priority <= 0) return;
  report.scheduler_errno = set_fifo(priority);
  if (report.scheduler_errno == 0) {
    report.fifo_priority = priority;
  } else if (const int lower = std::min(priority, allowed_priority()); lower > 0 && set_fifo(lower) == 0) {
    report.fifo_priority = lower;
  }
}

void be_nice(int nice, PlacementReport& report) {
  const auto thread = static_cast<id_t>(gettid());
  if (setpriority(PRIO_PROCESS, thread, nice) != 0) report.nice_errno = errno;
  report.nice = getpriority(PRIO_PROCESS, thread);
}

std::uint64_t mask_of(const cpu_set_t& set) {
  std::uint64_t mask = 0;
  for (int cpu = 0; cpu < kMaskBits; ++cpu) {
    if (CPU_ISSET(cpu, &set)) mask |= std::uint64_t{1} << static_cast<unsigned>(cpu);
  }
  return mask;
}

cpu_set_t set_of(std::uint64_t mask) {
  cpu_set_t set;
  CPU_ZERO(&set);
  for (int cpu = 0; cpu < kMaskBits; ++cpu) {
    if ((mask >> static_cast<unsigned>(cpu) & 1U) != 0) CPU_SET(cpu, &set);
  }
  return set;
}

std::uint64_t allowed_cpus() {
  cpu_set_t set;
  CPU_ZERO(&set);
  return pthread_getaffinity_np(pthread_self(), sizeof set, &set) == 0 ? mask_of(set) : 0;
}

void choose_cpus(std::uint64_t cpus, PlacementReport& report) {
  const std::uint64_t there = cpus & allowed_cpus();
  if (cpus != 0 && there == 0) report.affinity_errno = EINVAL;
  if (there != 0) {
    const cpu_set_t set = set_of(there);
    report.affinity_errno = pthread_setaffinity_np(pthread_self(), sizeof set, &set);
  }
  report.cpus = allowed_cpus();
}

}  // namespace

PlacementReport place_this_thread(const ThreadPlacement& wanted) {
  PlacementReport report;
  set_name(wanted.name);
  choose_cpus(wanted.cpus, report);
  if (wanted.fifo_priority == 0) be_nice(wanted.nice, report);
  schedule(wanted.fifo_priority, report);
  report.stack_bytes = prefault_stack(wanted.stack_bytes);
  return report;
}

}  // namespace lxd
