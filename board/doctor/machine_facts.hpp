// SPDX-License-Identifier: Apache-2.0
// What a machine is, as far as real time depends on it: read from the kernel's files, and judged nowhere here.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace lxd {

// A limit of the process; the largest number: unlimited.
inline constexpr std::uint64_t kUnlimited = ~std::uint64_t{0};

struct IdleState {
  std::string name;
  std::uint32_t latency_us = 0;  // to wake from it
};

struct GroupFact {
  std::string name;
  bool exists = false;
  bool member = false;  // of the process
};

// None, empty: the file is not there or says something else.
struct MachineFacts {
  std::string kernel;  // "6.1.0-18-rt-amd64"
  int kernel_major = 0, kernel_minor = 0;
  bool preempt_rt = false;
  std::optional<std::uint64_t> receive_buffer_max_bytes;  // net.core.rmem_max
  std::optional<std::int64_t> real_time_share_us;         // kernel.sched_rt_runtime_us of each second; -1: all
  std::optional<std::uint64_t> locked_memory_max_bytes;   // the process's limit
  std::optional<std::uint64_t> real_time_priority_max;    // likewise
  bool may_lock_memory = false;                           // CAP_IPC_LOCK
  bool may_raise_priority = false;                        // CAP_SYS_NICE
  bool root = false;
  std::optional<std::uint64_t> available_memory_bytes;
  std::vector<std::string> governors;  // of each CPU that has one
  std::vector<std::string> pps_devices;
  std::vector<GroupFact> groups;  // kDeviceGroups
  std::string clock_source;
  std::vector<IdleState> idle_states;  // of CPU 0, those in use
  std::string online_cpus, isolated_cpus;
  std::uint32_t cpu_count = 0;
  std::string huge_pages;  // always | madvise | never
};

// Groups that the rights to devices go by: serial lines and pulses, cameras, USB, GPIO.
inline constexpr const char* kDeviceGroups[] = {"dialout", "video", "plugdev", "gpio"};

// From the files below root: "/" for this machine.
MachineFacts read_machine_facts(const std::filesystem::path& root);

}  // namespace lxd
