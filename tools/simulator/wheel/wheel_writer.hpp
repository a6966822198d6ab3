// SPDX-License-Identifier: Apache-2.0
// The wheels of a recording: can.log, and wheel.csv on request.
#pragma once

#include <filesystem>
#include <span>

#include "rt/result.hpp"
#include "tools/simulator/context.hpp"
#include "tools/simulator/wheel/wheel_config.hpp"

namespace lxd::sim {

struct WheelLog {
  std::uint64_t frames = 0;        // all data frames, as follows
  std::uint64_t wheel_frames = 0;  // of the decoder's tables
  std::uint64_t other_frames = 0;
  std::uint64_t bad_checksums = 0;  // by fault
  std::uint64_t error_frames = 0;
  std::uint64_t withheld = 0;  // not sent: the bus was off
  double slip_s = 0;           // not by fault
};

std::span<const KnownFault> wheel_faults();

// What can be known before work begins. Error: can_checksum of a protocol that has none.
Status check_wheel(const WheelConfig& config, const FaultPlan& faults);

// Errors name the file: check_wheel()'s, and whatever cannot be written. No file is left then.
Result<WheelLog> write_wheel(const Context& context, const WheelConfig& config, const std::filesystem::path& folder);

}  // namespace lxd::sim
