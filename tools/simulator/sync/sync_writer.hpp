// SPDX-License-Identifier: Apache-2.0
// Time signals of a recording: pps.csv (the kernel's stamps of the pulse) and gpio.csv (every edge of the
// microcontroller's lines, as the kernel's line events have them).
#pragma once

#include <filesystem>
#include <span>

#include "drivers/replay/gpio_log.hpp"
#include "rt/result.hpp"
#include "tools/simulator/context.hpp"
#include "tools/simulator/sync/sync_config.hpp"

namespace lxd::sim {

struct SyncLog {
  std::uint64_t pulses = 0;       // true ones, written
  std::uint64_t missing = 0;      // pulses that did not come
  std::uint64_t spurious = 0;     // edges of the pulse's line that are none
  std::uint64_t gpio_events = 0;  // written
  std::uint64_t gpio_lost = 0;    // trigger edges that the kernel did not keep: gaps in seqno
};

std::span<const KnownFault> sync_faults();

// Errors name the file: whatever cannot be written. No file is left then.
Result<SyncLog> write_sync(const Context& context, const SyncConfig& config, const std::filesystem::path& folder);

}  // namespace lxd::sim
