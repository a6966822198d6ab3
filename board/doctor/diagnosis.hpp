// SPDX-License-Identifier: Apache-2.0
// What a machine lacks for real time, and how to mend it: a pure function of its facts.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "board/doctor/machine_facts.hpp"

namespace lxd {

enum class Verdict : std::uint8_t {
  good,
  advice,  // works without; better with
  lack     // real time is not to be had without, or sensors are not heard
};

struct Finding {
  Verdict verdict = Verdict::good;
  std::string subject;
  std::string found;  // and, but for good ones, what is wanted
  std::string mend;   // empty for good ones
};

// What the board profile wants of the machine.
struct MachineNeeds {
  std::uint64_t receive_buffer_bytes = 0;
  std::uint64_t memory_bytes = 0;        // of the process, all of it to be locked
  std::uint64_t real_time_priority = 0;  // the highest of its threads
};
MachineNeeds needs_of_this_profile();

// In a fixed order, each subject once.
std::vector<Finding> diagnose(const MachineFacts& facts, const MachineNeeds& needs);

// For people: a line a finding, below it how to mend, at the end the count.
std::string diagnosis_text(const std::vector<Finding>& findings);

}  // namespace lxd
