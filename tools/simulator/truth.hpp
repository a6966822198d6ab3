// SPDX-License-Identifier: Apache-2.0
// The exact truth beside a recording.
#pragma once

#include <filesystem>
#include <span>
#include <string>

#include "rt/result.hpp"
#include "tools/simulator/clock.hpp"
#include "tools/simulator/context.hpp"

namespace lxd::sim {

// truth.tum: the reference frame's path at 200 Hz, rig time.
Status write_true_path(const Context& context, const std::filesystem::path& folder);

struct NamedClock {
  std::string sensor;
  ClockConfig clock;
  std::int64_t shift_ns = 0;  // added to its stamps: a sensor that counts from when it was switched on
};

// clocks.csv: `sensor,rig_ns,sensor_ns`, a line each second: what a clock model should have found. A sensor whose clock
// is made wrong by a fault is in it up to the fault's begin.
Status write_true_clocks(const Context& context, std::span<const NamedClock> clocks,
                         const std::filesystem::path& folder);

}  // namespace lxd::sim
