// SPDX-License-Identifier: Apache-2.0
// `pps.csv` of a recording: the kernel's stamps of the assert edges (unix ns) with its count of them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "rt/result.hpp"
#include "rt/time.hpp"

namespace lxd {

inline constexpr const char* kPpsLogFile = "pps.csv";
inline constexpr const char* kPpsLogHeader = "assert_ns,sequence";

struct PpsEdge {
  RigTime asserted;
  std::uint32_t sequence = 0;  // a gap: edges that were not read in time

  bool operator==(const PpsEdge&) const = default;
};

struct PpsLog {
  std::vector<PpsEdge> edges;  // in the file's order
  std::uint64_t lost = 0;      // by gaps in the sequence
};

// Errors name file and line: a missing file, a wrong header, a line that is no edge, a sequence that goes back.
Result<PpsLog> read_pps_log(const std::filesystem::path& path);

// The pulses of a recording's folder, for a sensor whose clock goes by them if `pulsed`; otherwise, or without the
// file, none. Errors as above.
Result<std::vector<RigTime>> recorded_pulses(const std::filesystem::path& folder, bool pulsed);

}  // namespace lxd
