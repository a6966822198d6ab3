// SPDX-License-Identifier: Apache-2.0
// See placement_text.hpp.
#include "board/placement_text.hpp"

#include <bit>
#include <cstring>

#include <fmt/format.h>

namespace lxd {

std::string cpu_list(std::uint64_t cpus) {
  std::string list;
  while (cpus != 0) {
    const int first = std::countr_zero(cpus);
    const int count = std::countr_one(cpus >> static_cast<unsigned>(first));
    list += fmt::format("{}{}", list.empty() ? "" : ",", first);
    if (count > 1) list += fmt::format("-{}", first + count - 1);
    if (first + count >= 64) break;
    cpus &= ~std::uint64_t{0} << static_cast<unsigned>(first + count);
  }
  return list.empty() ? "none" : list;
}

std::string placement_text(const ThreadPlacement& wanted, const PlacementReport& report) {
  const std::string scheduler = report.fifo_priority > 0 ? fmt::format("SCHED_FIFO {}", report.fifo_priority)
                                                         : fmt::format("ordinary scheduler, nice {}", report.nice);
  std::string text = fmt::format("{}: {}, CPUs {}", wanted.name, scheduler, cpu_list(report.cpus));
  const auto refused = [&](const std::string& what, int cause) {
    if (cause != 0) text += fmt::format("; {} was refused ({})", what, std::strerror(cause));
  };
  refused(fmt::format("SCHED_FIFO {}", wanted.fifo_priority), report.scheduler_errno);
  refused(fmt::format("nice {}", wanted.nice), report.nice_errno);
  refused(fmt::format("CPUs {}", cpu_list(wanted.cpus)), report.affinity_errno);
  if (report.scheduler_errno != 0 || report.nice_errno != 0) text += ": see lxd-slam doctor";
  return text;
}

}  // namespace lxd
