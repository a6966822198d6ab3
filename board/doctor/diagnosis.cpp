// SPDX-License-Identifier: Apache-2.0
// See diagnosis.hpp. The numbers wanted are explained where they stand; board/README.md names the sources.
#include "board/doctor/diagnosis.hpp"

#include <algorithm>
#include <array>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "board/default/capacities.hpp"
#include "board/default/threads.hpp"

namespace lxd {
namespace {

// The densest LiDAR (OS1-128, 20 Hz, two returns) sends 42 MB/s; a reader that is late by 50 ms needs 2.1 MB, and the
// kernel charges a datagram of 33 kB about twice its size.
constexpr std::uint64_t kReceiveBuffer_bytes = std::uint64_t{8} << 20;
// Waking must stay small beside the filter's period of some milliseconds.
constexpr std::uint32_t kWakeLatencyMax_us = 100;
// Below, the kernel takes the CPU from real-time threads for a larger part of each second than its own default does.
constexpr std::int64_t kRealTimeShareMin_us = 950'000;
// madvise(MADV_POPULATE_WRITE) came with it: without, page faults cannot be avoided without being root.
constexpr int kKernelMajorMin = 5, kKernelMinorMin = 14;
constexpr std::uint32_t kCpusWanted = 4;

Finding good(std::string subject, std::string found) {
  return {Verdict::good, std::move(subject), std::move(found), {}};
}
Finding lack(std::string subject, std::string found, std::string mend) {
  return {Verdict::lack, std::move(subject), std::move(found), std::move(mend)};
}
Finding advice(std::string subject, std::string found, std::string mend) {
  return {Verdict::advice, std::move(subject), std::move(found), std::move(mend)};
}

std::string amount(std::uint64_t value) { return value == kUnlimited ? "unlimited" : fmt::format("{}", value); }

Finding kernel(const MachineFacts& facts) {
  const bool new_enough = facts.kernel_major > kKernelMajorMin ||
                          (facts.kernel_major == kKernelMajorMin && facts.kernel_minor >= kKernelMinorMin);
  const std::string name = facts.kernel.empty() ? "unknown" : facts.kernel;
  if (!new_enough)
    return lack("kernel", fmt::format("{}; wanted {}.{} or later", name, kKernelMajorMin, kKernelMinorMin),
                "install the distribution's present kernel");
  if (!facts.preempt_rt)
    return advice("kernel", name + " without PREEMPT_RT: now and then a thread wakes tens of milliseconds late",
                  "apt install linux-image-rt-$(dpkg --print-architecture), and boot it");
  return good("kernel", name + ", PREEMPT_RT");
}

Finding priority(const MachineFacts& facts, const MachineNeeds& needs) {
  const std::string subject = "real-time priority";
  if (facts.may_raise_priority) return good(subject, "any (CAP_SYS_NICE)");
  const std::uint64_t limit = facts.real_time_priority_max.value_or(0);
  if (limit >= needs.real_time_priority) return good(subject, fmt::format("limit {}", amount(limit)));
  return lack(subject, fmt::format("limit {}; wanted at least {}", limit, needs.real_time_priority),
              "install board/system/60-lxd-slam-limits.conf as /etc/security/limits.d/60-lxd-slam.conf, "
              "adduser $USER lxd-slam, log in anew (the service has its own limits)");
}

Finding locked_memory(const MachineFacts& facts, const MachineNeeds& needs) {
  const std::string subject = "locked memory";
  if (facts.may_lock_memory) return good(subject, "any (CAP_IPC_LOCK)");
  const std::uint64_t limit = facts.locked_memory_max_bytes.value_or(0);
  if (limit >= needs.memory_bytes) return good(subject, fmt::format("limit {}", amount(limit)));
  return lack(subject, fmt::format("limit {} bytes; wanted at least {}", limit, needs.memory_bytes),
              "as for the real-time priority: memlock in /etc/security/limits.d/60-lxd-slam.conf");
}

Finding share(const MachineFacts& facts) {
  const std::string subject = "real-time share";
  const std::int64_t us = facts.real_time_share_us.value_or(-1);
  if (us == -1) return good(subject, "not limited");
  if (us >= kRealTimeShareMin_us) return good(subject, fmt::format("{} us of each second", us));
  return advice(subject, fmt::format("{} us of each second; wanted at least {}", us, kRealTimeShareMin_us),
                fmt::format("sysctl -w kernel.sched_rt_runtime_us={}", kRealTimeShareMin_us));
}

Finding receive_buffer(const MachineFacts& facts, const MachineNeeds& needs) {
  const std::string subject = "socket buffers";
  const std::uint64_t bytes = facts.receive_buffer_max_bytes.value_or(0);
  if (bytes >= needs.receive_buffer_bytes) return good(subject, fmt::format("net.core.rmem_max {}", bytes));
  return lack(subject,
              fmt::format("net.core.rmem_max {}; wanted at least {}: packets of a dense LiDAR are lost", bytes,
                          needs.receive_buffer_bytes),
              fmt::format("sysctl -w net.core.rmem_max={}; for good: board/system/60-lxd-slam-sysctl.conf as "
                          "/etc/sysctl.d/60-lxd-slam.conf",
                          needs.receive_buffer_bytes));
}

Finding memory(const MachineFacts& facts, const MachineNeeds& needs) {
  const std::string subject = "memory";
  if (!facts.available_memory_bytes) return advice(subject, "/proc/meminfo does not say", "mount /proc");
  const std::uint64_t bytes = *facts.available_memory_bytes;
  if (bytes >= needs.memory_bytes) return good(subject, fmt::format("{} bytes available", bytes));
  return lack(subject, fmt::format("{} bytes available; wanted at least {}", bytes, needs.memory_bytes),
              "end other programs, or build a smaller board profile (lxd-slam budget)");
}

Finding governor(const MachineFacts& facts) {
  const std::string subject = "CPU frequency";
  if (facts.governors.empty()) return good(subject, "not ours to set");
  const auto slow = std::ranges::count_if(facts.governors, [](const auto& name) { return name != "performance"; });
  if (slow == 0) return good(subject, "governor performance");
  const auto other = std::ranges::find_if(facts.governors, [](const auto& name) { return name != "performance"; });
  return lack(subject,
              fmt::format("governor {} on {} of {} CPUs; wanted performance", *other, slow, facts.governors.size()),
              "cpupower frequency-set -g performance; for good: board/system/lxd-slam-tmpfiles.conf as "
              "/etc/tmpfiles.d/lxd-slam.conf");
}

Finding idle(const MachineFacts& facts) {
  const std::string subject = "idle states";
  const auto deepest = std::ranges::max_element(facts.idle_states, {}, &IdleState::latency_us);
  if (deepest == facts.idle_states.end()) return good(subject, "none");
  const std::string found = fmt::format("{} wakes in {} us", deepest->name, deepest->latency_us);
  if (deepest->latency_us <= kWakeLatencyMax_us) return good(subject, found);
  return advice(subject, fmt::format("{}; wanted at most {}", found, kWakeLatencyMax_us),
                fmt::format("cpupower idle-set -D {}", kWakeLatencyMax_us));
}

Finding cpus(const MachineFacts& facts) {
  const std::string subject = "CPUs";
  const std::string online = fmt::format("{} online", facts.online_cpus.empty() ? "?" : facts.online_cpus);
  if (facts.cpu_count < kCpusWanted)
    return advice(subject, fmt::format("{}; wanted {}: threads share them", online, kCpusWanted), "a larger board");
  if (facts.isolated_cpus.empty())
    return advice(subject, online + ", none isolated: other programs run on the filter's",
                  "kernel parameters isolcpus=3 nohz_full=3 rcu_nocbs=3 irqaffinity=0-2");
  return good(subject, fmt::format("{}, {} isolated", online, facts.isolated_cpus));
}

Finding clock(const MachineFacts& facts) {
  constexpr std::array<std::string_view, 5> kSlow{"hpet", "acpi_pm", "jiffies", "refined-jiffies", "pit"};
  const std::string subject = "clock source";
  if (facts.clock_source.empty()) return advice(subject, "unknown", "mount /sys");
  if (std::ranges::find(kSlow, facts.clock_source) == kSlow.end()) return good(subject, facts.clock_source);
  return lack(subject, facts.clock_source + ": reading the time costs microseconds, or is coarse",
              "dmesg says why the CPU's own counter is not trusted; kernel parameter clocksource=tsc where it may be");
}

Finding huge_pages(const MachineFacts& facts) {
  const std::string subject = "huge pages";
  if (facts.huge_pages != "always") return good(subject, facts.huge_pages.empty() ? "none" : facts.huge_pages);
  return advice(subject, "always: the kernel moves pages together while programs run; wanted madvise",
                "echo madvise > /sys/kernel/mm/transparent_hugepage/enabled; for good: "
                "board/system/lxd-slam-tmpfiles.conf");
}

Finding pulses(const MachineFacts& facts) {
  const std::string subject = "pulse per second";
  if (!facts.pps_devices.empty()) return good(subject, fmt::format("/dev/{}", fmt::join(facts.pps_devices, ", /dev/")));
  return advice(
      subject, "no /dev/pps*: sensor clocks are learned from arrival times, to a millisecond",
      "modprobe pps-gpio with a line in the device tree, or pps-ldisc and ldattach 18 on a serial line's DCD");
}

Finding group(const MachineFacts& facts, const GroupFact& group) {
  const std::string subject = "group " + group.name;
  if (facts.root) return good(subject, "not needed by root");
  if (group.member) return good(subject, "member");
  if (!group.exists)
    return advice(subject, "does not exist",
                  fmt::format("groupadd --system {0}; board/system has its udev rule", group.name));
  return lack(subject, "not a member: its devices cannot be opened",
              fmt::format("adduser $USER {}, log in anew", group.name));
}

std::string_view name_of(Verdict verdict) {
  constexpr std::array<std::string_view, 3> kNames{"good", "advice", "LACK"};
  return kNames[static_cast<std::size_t>(verdict)];
}

}  // namespace

MachineNeeds needs_of_this_profile() {
  const auto highest = std::ranges::max(threads::kAll, {}, &ThreadPlacement::fifo_priority);
  return {kReceiveBuffer_bytes, capacities::kPeakRssBytes, static_cast<std::uint64_t>(highest.fifo_priority)};
}

std::vector<Finding> diagnose(const MachineFacts& facts, const MachineNeeds& needs) {
  std::vector<Finding> findings{kernel(facts),
                                priority(facts, needs),
                                locked_memory(facts, needs),
                                share(facts),
                                receive_buffer(facts, needs),
                                memory(facts, needs),
                                governor(facts),
                                idle(facts),
                                cpus(facts),
                                clock(facts),
                                huge_pages(facts),
                                pulses(facts)};
  for (const GroupFact& each : facts.groups) findings.push_back(group(facts, each));
  return findings;
}

std::string diagnosis_text(const std::vector<Finding>& findings) {
  std::string text;
  for (const Finding& finding : findings) {
    text += fmt::format("{:<6}  {:<18}  {}\n", name_of(finding.verdict), finding.subject, finding.found);
    if (!finding.mend.empty()) text += fmt::format("{:<6}  {:<18}  -> {}\n", "", "", finding.mend);
  }
  const auto count = [&](Verdict verdict) { return std::ranges::count(findings, verdict, &Finding::verdict); };
  return text + fmt::format("{} lacking, {} advised, {} good\n", count(Verdict::lack), count(Verdict::advice),
                            count(Verdict::good));
}

}  // namespace lxd
