// SPDX-License-Identifier: Apache-2.0
// Threads of the default board profile: which there are, how urgent, and on which CPUs of a board with four. The
// shorter a thread's work, the more urgent it is: stamps of edges, then bytes off the wires, then the filter, whose
// sweep takes tens of milliseconds. Vision, back-end and housekeeping share what is left under the ordinary scheduler.
// With PREEMPT_RT interrupts are threads of SCHED_FIFO 50: the filter stays below them, as what it waits for comes
// through them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "rt/thread_placement.hpp"

namespace lxd::threads {

inline constexpr std::size_t kKibibyte = 1024;
// CPUs 0 and 1 take interrupts and everything else; 2 is the vision's and the back-end's; 3 is the filter's alone. On a
// board with fewer CPUs what is not there is any.
inline constexpr std::uint64_t kCommonCpus = 0b0011, kHeavyCpus = 0b0111, kFilterCpus = 0b1000;

inline constexpr ThreadPlacement kWatchdog{
    .name = "lxd-watchdog", .fifo_priority = 90, .cpus = kCommonCpus, .stack_bytes = 32 * kKibibyte};
inline constexpr ThreadPlacement kSync{
    .name = "lxd-sync", .fifo_priority = 75, .cpus = kCommonCpus, .stack_bytes = 32 * kKibibyte};
inline constexpr ThreadPlacement kInput{
    .name = "lxd-input", .fifo_priority = 70, .cpus = kCommonCpus, .stack_bytes = 128 * kKibibyte};
inline constexpr ThreadPlacement kFilter{
    .name = "lxd-filter", .fifo_priority = 45, .cpus = kFilterCpus, .stack_bytes = 512 * kKibibyte};
inline constexpr ThreadPlacement kVision{.name = "lxd-vision", .nice = -5, .cpus = kHeavyCpus};
inline constexpr ThreadPlacement kRecorder{.name = "lxd-recorder", .nice = 0, .cpus = kCommonCpus};
inline constexpr ThreadPlacement kHousekeeping{.name = "lxd-house", .nice = 5, .cpus = kCommonCpus};
inline constexpr ThreadPlacement kBackEnd{.name = "lxd-backend", .nice = 10, .cpus = kHeavyCpus};

inline constexpr std::array kAll{kWatchdog, kSync, kInput, kFilter, kVision, kRecorder, kHousekeeping, kBackEnd};

}  // namespace lxd::threads
