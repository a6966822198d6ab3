// SPDX-License-Identifier: Apache-2.0
// Faults as the user writes them: NAME[@BEGIN[+DURATION]][=VALUE], times in seconds, e.g. lidar0_loss@10+5=0.33.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "rt/result.hpp"
#include "tools/simulator/faults.hpp"

namespace lxd::sim {

// What is not written is taken from the fault's entry in `known`. The error names the text, what is wrong with it, and
// for an unknown name the nearest known ones.
Result<Fault> parse_fault(std::string_view text, std::span<const KnownFault> known);

// All of them; the error has a line for each that is wrong, begins after the recording's end, or overlaps in time with
// an earlier one of its name.
Result<FaultPlan> plan_faults(std::span<const std::string> texts, std::span<const KnownFault> known, double duration_s);

// One line a fault: name, what it does, defaults.
std::string fault_list(std::span<const KnownFault> known);

}  // namespace lxd::sim
