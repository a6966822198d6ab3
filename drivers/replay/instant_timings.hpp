// SPDX-License-Identifier: Apache-2.0
// Sweeps of which only one time is known: begin, stamp and end are that one.
#pragma once

#include <vector>

#include "drivers/replay/scan_source.hpp"
#include "drivers/replay/times_file.hpp"

namespace lxd {

inline std::vector<std::optional<SweepTiming>> instant_timings(const StampLines& stamps) {
  std::vector<std::optional<SweepTiming>> timings(stamps.size());
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    if (stamps[i]) timings[i] = SweepTiming{*stamps[i], *stamps[i], *stamps[i]};
  }
  return timings;
}

}  // namespace lxd
