// SPDX-License-Identifier: Apache-2.0
// See machine_facts.hpp. Sources: the kernel's Documentation/admin-guide (sysctl, pm/cpuidle, pm/cpufreq, mm/transhuge)
// and proc(5).
#include "board/doctor/machine_facts.hpp"

#include <algorithm>
#include <charconv>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string_view>

namespace lxd {
namespace {

namespace fs = std::filesystem;

constexpr unsigned kCapIpcLock = 14, kCapSysNice = 23;  // linux/capability.h

std::string text_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  return text;
}

template <typename Number>
std::optional<Number> number_in(std::string_view text, int base = 10) {
  Number number{};
  const auto [rest, failed] = std::from_chars(text.data(), text.data() + text.size(), number, base);
  return failed == std::errc() ? std::optional(number) : std::nullopt;
}

// The rest of the line that begins with the key, without leading blanks.
std::string value_of(const std::string& text, std::string_view key) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    if (!line.starts_with(key)) continue;
    const auto begin = line.find_first_not_of(" \t", key.size());
    return begin == std::string::npos ? "" : line.substr(begin);
  }
  return {};
}

// The soft limit of a row of /proc/self/limits.
std::optional<std::uint64_t> limit_of(const std::string& limits, std::string_view name) {
  const std::string row = value_of(limits, name);
  if (row.starts_with("unlimited")) return kUnlimited;
  return number_in<std::uint64_t>(row);
}

// Names below a folder that begin with the prefix, sorted.
std::vector<std::string> names_in(const fs::path& folder, std::string_view prefix) {
  std::vector<std::string> names;
  std::error_code failed;
  for (fs::directory_iterator at(folder, failed), end; !failed && at != end; at.increment(failed)) {
    std::string name = at->path().filename().string();
    if (name.starts_with(prefix)) names.push_back(std::move(name));
  }
  std::ranges::sort(names);
  return names;
}

void read_kernel(const fs::path& root, MachineFacts& facts) {
  facts.kernel = text_of(root / "proc/sys/kernel/osrelease");
  const std::string_view release = facts.kernel;
  facts.kernel_major = number_in<int>(release).value_or(0);
  const auto dot = release.find('.');
  if (dot != std::string_view::npos) facts.kernel_minor = number_in<int>(release.substr(dot + 1)).value_or(0);
  facts.preempt_rt = text_of(root / "sys/kernel/realtime") == "1" ||
                     text_of(root / "proc/version").find("PREEMPT_RT") != std::string::npos;
  facts.receive_buffer_max_bytes = number_in<std::uint64_t>(text_of(root / "proc/sys/net/core/rmem_max"));
  facts.real_time_share_us = number_in<std::int64_t>(text_of(root / "proc/sys/kernel/sched_rt_runtime_us"));
  facts.clock_source = text_of(root / "sys/devices/system/clocksource/clocksource0/current_clocksource");
}

void read_process(const fs::path& root, MachineFacts& facts) {
  const std::string limits = text_of(root / "proc/self/limits");
  facts.locked_memory_max_bytes = limit_of(limits, "Max locked memory");
  facts.real_time_priority_max = limit_of(limits, "Max realtime priority");
  const std::string status = text_of(root / "proc/self/status");
  const std::uint64_t capabilities = number_in<std::uint64_t>(value_of(status, "CapEff:"), 16).value_or(0);
  facts.may_lock_memory = (capabilities >> kCapIpcLock & 1U) != 0;
  facts.may_raise_priority = (capabilities >> kCapSysNice & 1U) != 0;
  facts.root = number_in<int>(value_of(status, "Uid:")) == 0;
}

// The groups of the process, its own and the supplementary ones.
std::vector<std::string> group_numbers(const std::string& status) {
  std::istringstream words(value_of(status, "Gid:") + " " + value_of(status, "Groups:"));
  return {std::istream_iterator<std::string>(words), {}};
}

// name:password:number:members; empty: no such group.
std::string number_of_group(const std::string& file, const std::string& name) {
  const std::string row = value_of(file, name + ":");
  const auto begin = row.find(':') + 1;  // 0 where there is no colon
  return begin == 0 ? "" : row.substr(begin, row.find(':', begin) - begin);
}

void read_groups(const fs::path& root, MachineFacts& facts) {
  const std::string file = text_of(root / "etc/group");
  const std::vector<std::string> mine = group_numbers(text_of(root / "proc/self/status"));
  for (const char* const name : kDeviceGroups) {
    const std::string number = number_of_group(file, name);
    facts.groups.push_back({name, !number.empty(), std::ranges::find(mine, number) != mine.end()});
  }
}

void read_idle_states(const fs::path& folder, MachineFacts& facts) {
  for (const std::string& state : names_in(folder, "state")) {
    const bool disabled = text_of(folder / state / "disable") == "1";
    const auto latency = number_in<std::uint32_t>(text_of(folder / state / "latency"));
    if (!disabled && latency) facts.idle_states.push_back({text_of(folder / state / "name"), *latency});
  }
}

void read_cpus(const fs::path& root, MachineFacts& facts) {
  const fs::path folder = root / "sys/devices/system/cpu";
  facts.online_cpus = text_of(folder / "online");
  facts.isolated_cpus = text_of(folder / "isolated");
  for (const std::string& cpu : names_in(folder, "cpu")) {
    if (!number_in<unsigned>(std::string_view(cpu).substr(3))) continue;  // cpufreq, cpuidle
    ++facts.cpu_count;
    std::string governor = text_of(folder / cpu / "cpufreq/scaling_governor");
    if (!governor.empty()) facts.governors.push_back(std::move(governor));
  }
  read_idle_states(folder / "cpu0/cpuidle", facts);
}

void read_memory(const fs::path& root, MachineFacts& facts) {
  constexpr std::uint64_t kKibibyte = 1024;
  const auto available = number_in<std::uint64_t>(value_of(text_of(root / "proc/meminfo"), "MemAvailable:"));
  if (available) facts.available_memory_bytes = *available * kKibibyte;
  // "always [madvise] never": the one in brackets is in force.
  const std::string choice = text_of(root / "sys/kernel/mm/transparent_hugepage/enabled");
  const auto begin = choice.find('['), end = choice.find(']');
  if (begin < end && end != std::string::npos) facts.huge_pages = choice.substr(begin + 1, end - begin - 1);
}

}  // namespace

MachineFacts read_machine_facts(const fs::path& root) {
  MachineFacts facts;
  read_kernel(root, facts);
  read_process(root, facts);
  read_groups(root, facts);
  read_cpus(root, facts);
  read_memory(root, facts);
  facts.pps_devices = names_in(root / "dev", "pps");
  return facts;
}

}  // namespace lxd
